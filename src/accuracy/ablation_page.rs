//! What each effect changes and costs, as text.

use super::ablation::{Ablation, Idle, Outcome, Switched};
use crate::dynamics::OutOfReach;
use crate::measure::column_words;
use crate::text::number::{quantity, significant};
use crate::text::words;

use crate::report::markdown::{Align, MarkdownTable, one_line};

/// A change smaller than this is rounding.
const ROUNDING: f64 = 1e-11;

/// All cases of an experiment, Markdown.
#[must_use]
pub fn ablation_page(cases: &[Ablation]) -> String {
    let mut text = String::new();
    for (number, case) in cases.iter().enumerate() {
        let description =
            if case.description.is_empty() { String::new() } else { format!(": {}", one_line(&case.description)) };
        text += &format!("## Case {}{description}\n\n", number + 1);
        text += &format!("As it is: {} events, {} a run (median).", case.events, seconds(case.times.median));
        if case.closed_form {
            text += " It is proved that no particle leaves its floor: the run is in closed form, and what only a particle in \
                     flight can meet is skipped.";
        }
        if case.chaotic {
            text += " The motion is chaotic: a change of the measures may be no more than that.";
        }
        text += "\n\n";
        let mut rows = MarkdownTable::new(&[
            ("Effect", Align::Left),
            ("In the scene", Align::Left),
            ("Switched", Align::Left),
            ("Largest change", Align::Right),
            ("Of", Align::Left),
            ("Events", Align::Right),
            ("Median time", Align::Right),
        ]);
        for one in &case.switched {
            rows.row(row(one, case));
        }
        text += &rows.finish();
    }
    text
}

fn row(Switched { effect, in_force, outcome }: &Switched, case: &Ablation) -> [String; 7] {
    let scene = if *in_force { "in force" } else { "left out" };
    let cells = |switched: &str| {
        let empty = String::new;
        [(*effect).into(), scene.into(), switched.into(), empty(), empty(), empty(), empty()]
    };
    match outcome {
        Outcome::Idle(idle) => {
            let why = match idle {
                Idle::OnFloors => String::new(),
                Idle::OutOfReach(far) => format!(": {}", out_of_reach_in_words(*far)),
            };
            let [effect, _, _, a, b, c, d] = cells("");
            [effect, "named, idle".into(), format!("skipped already{why}"), a, b, c, d]
        }
        Outcome::Not(why) => cells(&format!("no: {why}")),
        Outcome::Changed { change, worst, events, times } => {
            let [effect, scene, ..] = cells("");
            let change =
                if *change < ROUNDING { "none".into() } else { format!("{} %", significant(100.0 * change, 2)) };
            [
                effect,
                scene,
                if *in_force { "off" } else { "on" }.into(),
                change,
                column_words(&words::of_key(worst)),
                format!("{events}"),
                format!("{}, × {}", seconds(times.median), significant(times.median / case.times.median, 2)),
            ]
        }
    }
}

/// How far away a surface is, and how far a particle comes.
#[must_use]
pub fn out_of_reach_in_words(OutOfReach { distance, reach, .. }: OutOfReach) -> String {
    format!(
        "{} away, and the energy of the run takes a particle {} at most",
        quantity(distance, "m", 3),
        quantity(reach, "m", 3)
    )
}

fn seconds(value: f64) -> String {
    quantity(value, "s", 3)
}
