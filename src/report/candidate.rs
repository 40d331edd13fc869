//! What an optimisation found: every candidate beside the first, and which of the differences are none.

use crate::experiment::{GapWord, Goal, Optimise};
use crate::measure::column_words;
use crate::table::Table;
use crate::text::number::{compact, quantity, significant};
use crate::text::words::{self, counted};

use super::markdown::{Align, MarkdownTable};
use crate::text::name;

/// The section on an experiment's page.
pub(super) fn section(optimise: &Optimise, table: &Table) -> String {
    let table = table.baseline();
    let rows = Rows::of(optimise, &table);
    if rows.list.is_empty() {
        return String::new();
    }
    let mut text = String::from("## What the searches found\n\n");
    text += &rows.best(optimise);
    text += &rows.table(optimise);
    if optimise.measure.is_ratio_to_undamped() && rows.any_below_one() {
        let measure = column_words(&words::of_key(&optimise.measure));
        text += &format!("A {measure} below 1 means harm: the structure moves more with its dampers than without.\n\n");
    }
    text += &format!(
        "A search sees one run for each setting; its result is evaluated again as the mean over an ensemble, ± one standard error. \
         Improvements are against {}; one within its standard error is noise.\n\n",
        rows.list[0].name
    );
    text
}

struct Row {
    name: String,
    gaps: Vec<f64>,
    fitness: [f64; 2],
    improvement: [f64; 2],
    evaluations: f64,
    stopped: String,
}

impl Row {
    /// Smaller is better; what has no number is the worst.
    fn order(&self, goal: Goal) -> f64 {
        match goal {
            _ if self.fitness[0].is_nan() => f64::INFINITY,
            Goal::Minimise => self.fitness[0],
            Goal::Maximise => -self.fitness[0],
        }
    }
}

struct Rows {
    list: Vec<Row>,
    unit: &'static str,
    gap_unit: &'static str,
}

impl Rows {
    fn of(optimise: &Optimise, table: &Table) -> Self {
        let floats = |name: &str| table.floats(name).unwrap_or_default();
        let (names, stopped) =
            (table.texts("candidate").unwrap_or_default(), table.texts("stopped").unwrap_or_default());
        let measure = words::of_key(&optimise.measure);
        let word = words::of_key(&optimise.gaps);
        let gaps: Vec<Vec<f64>> = (1..=optimise.bounds.len()).map(|gap| floats(&format!("{word}_{gap}"))).collect();
        let (value, error) = (floats(&measure), floats(&name::numerical(&measure)));
        let (better, better_error) = (floats("improvement"), floats("improvement_num"));
        let (seeds, varied, evaluations) = (floats("seed"), floats("varied"), floats("evaluations"));
        let at = |column: &[f64], row: usize| column.get(row).copied().unwrap_or(f64::NAN);
        let list = (0..names.len()).filter(|row| at(&varied, *row).is_nan()).map(|row| {
            let name = words::of_level("candidate", &names[row]);
            let seed = at(&seeds, row);
            Row {
                name: if seed.is_nan() { name } else { format!("{name}, seed {seed}") },
                gaps: gaps.iter().map(|gap| at(gap, row)).collect(),
                fitness: [at(&value, row), at(&error, row)],
                improvement: [at(&better, row), at(&better_error, row)],
                evaluations: at(&evaluations, row),
                stopped: stopped.get(row).cloned().unwrap_or_default(),
            }
        });
        let gap_unit = match optimise.gaps {
            GapWord::Gap => "m",
            GapWord::GapRatio => "",
        };
        Self { list: list.collect(), unit: optimise.measure.unit(), gap_unit }
    }

    fn best(&self, optimise: &Optimise) -> String {
        let order = |row: &Row| row.order(optimise.goal);
        let Some(best) = self.best_row(optimise) else { return String::new() };
        let measure = column_words(&words::of_key(&optimise.measure));
        let mut text = format!(
            "The best {measure} of {} is that of {}, {}: {}.",
            counted(self.list.len(), "candidate", "candidates"),
            best.name,
            self.fitness(best),
            if self.is_first(best) { "no other is better".into() } else { self.verdict(best) }
        );
        let tied: Vec<&str> = self
            .list
            .iter()
            .filter(|row| !std::ptr::eq(*row, best) && order(row) - order(best) <= error_of(row, best))
            .map(|row| row.name.as_str())
            .collect();
        if !tied.is_empty() {
            text += &format!(" No worse than it by more than the standard error: {}.", tied.join("; "));
        }
        text += &at_bounds(optimise, best);
        text + "\n\n"
    }

    fn best_row(&self, optimise: &Optimise) -> Option<&Row> {
        self.list.iter().min_by(|a, b| a.order(optimise.goal).total_cmp(&b.order(optimise.goal)))
    }

    /// Whether it is the one that the others are compared with.
    fn is_first(&self, row: &Row) -> bool {
        self.list.first().is_some_and(|first| std::ptr::eq(first, row))
    }

    fn any_below_one(&self) -> bool {
        self.list.iter().any(|row| row.fitness[0] < 1.0)
    }

    fn table(&self, optimise: &Optimise) -> String {
        let measure = column_words(&words::of_key(&optimise.measure));
        let mut table = MarkdownTable::new(&[
            ("Candidate", Align::Left),
            ("Gaps", Align::Left),
            (&words::capitalised(&measure), Align::Right),
            ("Improvement", Align::Right),
            ("", Align::Left),
            ("Short of the best", Align::Right),
            ("Evaluations", Align::Right),
            ("Ended by", Align::Left),
        ]);
        let best = self.best_row(optimise).map_or(f64::NAN, |best| best.fitness[0]);
        let short = |row: &Row| match 100.0 * (row.fitness[0] / best - 1.0).abs() {
            share if share.is_nan() => String::new(),
            share => format!("{} %", compact(share, 2)),
        };
        for row in &self.list {
            let gaps: Vec<String> = row
                .gaps
                .iter()
                .zip(&optimise.bounds)
                .map(|(gap, bounds)| {
                    let end = end_of(*gap, *bounds).map_or_else(String::new, |end| format!(" ({})", end.word()));
                    quantity(*gap, self.gap_unit, 3) + &end
                })
                .collect();
            let evaluations = if row.evaluations > 0.0 { format!("{}", row.evaluations) } else { String::new() };
            let [improvement, error] = row.improvement;
            let improvement =
                if improvement == 0.0 && error == 0.0 { String::new() } else { quantity(improvement, self.unit, 3) };
            let verdict = self.verdict(row);
            table.row([
                row.name.clone(),
                gaps.join(", "),
                self.fitness(row),
                improvement,
                verdict,
                short(row),
                evaluations,
                row.stopped.clone(),
            ]);
        }
        table.finish()
    }

    fn fitness(&self, row: &Row) -> String {
        let [value, error] = row.fitness;
        // Below a millionth it is rounding and not worth a reader's time.
        if error.abs() > 1e-6 * value.abs() {
            format!("{} ± {}", quantity(value, self.unit, 4), quantity(error, self.unit, 2))
        } else {
            quantity(value, self.unit, 4)
        }
    }

    /// The improvement in words.
    fn verdict(&self, row: &Row) -> String {
        let Some(first) = self.list.first() else { return String::new() };
        let [improvement, error] = row.improvement;
        if self.is_first(row) {
            return "reference".into();
        }
        if improvement == 0.0 && error == 0.0 {
            return format!("the same gaps as {}", first.name);
        }
        if improvement.is_nan() {
            return "not evaluated".into();
        }
        let percent = significant(100.0 * improvement.abs() / first.fitness[0].abs(), 2);
        if improvement.abs() <= error {
            format!("noise: {percent} %, within ±{}", compact(100.0 * error / first.fitness[0].abs(), 2) + " %")
        } else if improvement > 0.0 {
            format!("better by {percent} %")
        } else {
            format!("worse by {percent} %")
        }
    }
}

/// An end of the range that a search has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Least,
    Most,
}

impl End {
    fn word(self) -> &'static str {
        match self {
            Self::Least => "least allowed",
            Self::Most => "most allowed",
        }
    }
}

/// The end of its range that a gap lies at, up to what a search that closes in on it leaves.
fn end_of(gap: f64, [least, most]: [f64; 2]) -> Option<End> {
    let reach = 1e-6 * (most - least);
    match gap {
        gap if (gap - least).abs() <= reach => Some(End::Least),
        gap if (most - gap).abs() <= reach => Some(End::Most),
        _ => None,
    }
}

/// That the best gaps are no optimum within their ranges, where some lie at an end; a gap of zero has nothing below it.
fn at_bounds(optimise: &Optimise, best: &Row) -> String {
    let ends = best.gaps.iter().zip(&optimise.bounds).map(|(gap, bounds)| Some((end_of(*gap, *bounds)?, bounds[0])));
    let ends: Vec<(End, f64)> = ends.flatten().collect();
    if ends.is_empty() {
        return String::new();
    }
    let gaps = match (best.gaps.len(), ends.len()) {
        (1, _) => "Its gap lies at an end of its range".to_owned(),
        (all, 1) => format!("1 of its {all} gaps lies at an end of its range"),
        (all, many) => format!("{many} of its {all} gaps lie at ends of their ranges"),
    };
    let is_open = |(end, least): &(End, f64)| *end == End::Most || *least > 0.0;
    let beyond = if ends.iter().any(is_open) { ": a wider range may hold a better one" } else { "" };
    format!(" {gaps}{beyond}.")
}

/// Standard error of a difference.
fn error_of(a: &Row, b: &Row) -> f64 {
    (a.fitness[1] * a.fitness[1] + b.fitness[1] * b.fitness[1]).sqrt()
}
