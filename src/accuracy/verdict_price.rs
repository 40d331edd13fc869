//! Beside every verdict its price in time, as measured: by the solver that found it, and by the cheapest fixed step that would do.

use super::measured::{Accuracy, CaseAccuracy, Contender};
use super::timing::Times;
use crate::reference::{Comparison, Judged, Price, Verdict};
use crate::text::number::{quantity, significant};
use crate::text::words;

use super::over_cases::{Over, cheapest, fixed_steps, name, seconds};
use crate::report::comparison::rests_on;
use crate::report::markdown::{Align, MarkdownTable};

/// An entry, as far as its price depends on it.
#[derive(Debug, Clone, PartialEq)]
pub struct VerdictPrice {
    /// Its name without its experiment's.
    pub entry: String,
    /// Its verdict.
    pub verdict: Verdict,
    /// u_val over the published number; `None` for a claim.
    pub uncertainty: Option<f64>,
    /// The tolerance over the published number, the narrowest where there are several; `None` for a claim.
    pub tolerance: Option<f64>,
    /// What was simulated.
    pub price: Price,
    /// Runs behind each run of an ensemble: the points of a search for a maximum, the settings of a mean.
    pub factor: u64,
}

impl VerdictPrice {
    /// Of a verdict on an experiment whose rows take `factor` runs each.
    #[must_use]
    pub fn of(judged: &Judged, factor: u64) -> Self {
        let relative = |of: &dyn Fn(&Comparison) -> f64| {
            let sizes = judged.comparisons().map(|(_, one)| of(one) / one.published.abs());
            sizes.filter(|size| size.is_finite()).reduce(f64::min)
        };
        Self {
            entry: judged.id.rsplit('/').next().unwrap_or(&judged.id).into(),
            verdict: judged.verdict,
            uncertainty: relative(&Comparison::u_val),
            tolerance: relative(&Comparison::tolerance),
            price: judged.price,
            factor,
        }
    }
}

/// The section; nothing without entries that rest on a run.
pub(super) fn section(entries: &[VerdictPrice], accuracy: &Accuracy) -> String {
    let mut table = MarkdownTable::new(&[
        ("Entry", Align::Left),
        ("Verdict", Align::Left),
        ("u_val", Align::Right),
        ("Tolerance", Align::Right),
        ("Depends on", Align::Right),
        ("Event-driven", Align::Right),
        ("Cheapest fixed step within the tolerance", Align::Left),
    ]);
    let rates = Rates::of(accuracy);
    for one in entries.iter().filter(|one| one.price.rows > 0) {
        let runs = (one.price.runs * one.factor) as f64;
        table.row([
            format!("`{}`", one.entry),
            words::of_key(&one.verdict),
            one.uncertainty.map_or_else(|| "a claim".into(), share),
            one.tolerance.map_or_else(String::new, share),
            rests_on(one.price),
            rates.event_driven.map_or_else(String::new, |time| seconds(time * runs)),
            one.tolerance.map_or_else(String::new, |tolerance| rates.cheapest(tolerance, runs)),
        ]);
    }
    let table = table.finish();
    if table.is_empty() {
        return table;
    }
    format!("## What each verdict cost\n\n{table}")
}

/// What a run takes in the mean over cases, s.
struct Rates {
    event_driven: Option<f64>,
    /// Steps, s, with their errors and times over the cases that are not chaotic.
    steps: Vec<(f64, Over)>,
    regular: usize,
}

impl Rates {
    fn of(accuracy: &Accuracy) -> Self {
        let regular = accuracy.regular();
        let exact = |case: &CaseAccuracy| -> Option<Times> {
            case.points.iter().find(|point| point.contender == Contender::EXACT).map(|point| point.times)
        };
        let times: Vec<f64> = accuracy.cases.iter().filter_map(exact).map(|times| times.median).collect();
        Self {
            event_driven: (!times.is_empty()).then(|| times.iter().sum::<f64>() / times.len() as f64),
            steps: fixed_steps(&regular),
            regular: regular.len(),
        }
    }

    fn cheapest(&self, tolerance: f64, runs: f64) -> String {
        match cheapest(&self.steps, tolerance) {
            Some((time_step, of)) => {
                let time = of.time / self.regular as f64 * runs;
                format!("{}, {}", seconds(time), name(Contender::FixedStep { time_step }))
            }
            None if self.regular == 0 => "every case is chaotic".into(),
            None => "no step tried".into(),
        }
    }
}

/// `0.83 %`.
fn share(value: f64) -> String {
    if value < 1e-4 { significant(value, 2) } else { quantity(100.0 * value, "%", 2) }
}
