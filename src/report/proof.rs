//! What proves the runs: balances that hold whatever the motion does, and how clearly events were decided.

use crate::table::Table;
use crate::text::number::{self, quantity, significant};
use crate::text::words;

use super::markdown::escaped;
use crate::text::name;
use crate::text::words::counted;

/// What the column `chaotic` counts: a twin parts within the cycles of the run, whatever motion that ends in. The page counts the kinds of
/// motion elsewhere.
const SENSITIVE: &str = "rows sensitive to initial conditions";

/// The balances on an experiment's page; nothing without a table.
pub(super) fn section(table: Option<&Table>) -> String {
    let Some(table) = table else { return String::new() };
    let baseline = table.baseline();
    let mut text = String::new();
    for solver in solvers(&baseline) {
        let of_solver = baseline.select(&baseline.rows_where(name::SOLVER, &solver));
        let proof = Proof { table: &of_solver };
        let rows = counted(of_solver.rows(), "row", "rows");
        if proof.needs_no_run() {
            text += &format!("- {}: {rows}, computed without a run.\n", words::of_solver(&solver));
            continue;
        }
        text += &format!(
            "- {}: {rows}, events: {}, ties: {}; residual of momentum at most {}, of energy {}; smallest margin {}{}.\n",
            words::of_solver(&solver),
            proof.total("events"),
            proof.total("ties"),
            proof.worst("momentum_residual"),
            proof.worst("energy_residual"),
            proof.smallest_margin(),
            match (proof.total("chaotic").as_str(), proof.largest(name::MEMBERS).as_str()) {
                ("0", _) => String::new(),
                (rows, "1") => format!("; {SENSITIVE}: {rows}, each of a single run"),
                (rows, most) => format!("; {SENSITIVE}: {rows}, run as ensembles of up to {most} members"),
            }
        );
    }
    text.push('\n');
    let variants = table.rows().saturating_sub(baseline.rows());
    if variants > 0 {
        let rows = counted(variants, "more row has", "more rows have");
        text += &format!("{rows} one assumption moved, for u_input alone.\n\n");
    }
    if solvers(&baseline).iter().any(|solver| solver.starts_with("fixed_step")) {
        text += "The residuals of a fixed step are the error of the step itself: contacts are noticed up to a step late.\n\n";
    }
    text
}

/// The solvers of the rows, in their order.
fn solvers(table: &Table) -> Vec<String> {
    let mut solvers: Vec<String> = Vec::new();
    for solver in table.texts(name::SOLVER).unwrap_or_default() {
        if !solvers.contains(solver) {
            solvers.push(solver.clone());
        }
    }
    solvers
}

/// Runs without a result; nothing if all went well.
pub(super) fn failures(table: &Table) -> String {
    let mut reasons: Vec<(&String, usize)> = Vec::new();
    for reason in table.texts(name::FAILURE).unwrap_or_default().iter().filter(|reason| !reason.is_empty()) {
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, count)) => *count += 1,
            None => reasons.push((reason, 1)),
        }
    }
    if reasons.is_empty() {
        return String::new();
    }
    let mut text = String::from("**Runs that failed**\n\n");
    for (reason, count) in reasons {
        text += &format!("- {}: {}\n", counted(count, "run", "runs"), escaped(reason));
    }
    text + "\n"
}

/// The proof columns of some rows.
struct Proof<'a> {
    table: &'a Table,
}

impl Proof<'_> {
    /// All its numbers come from closed forms: there is no balance that could close.
    fn needs_no_run(&self) -> bool {
        let members = self.table.floats(name::MEMBERS).unwrap_or_default();
        let mut rows = members.iter().enumerate();
        !members.is_empty() && rows.all(|(row, members)| *members == 0.0 && !self.table.has_failed(row))
    }

    /// The finite numbers of a column.
    fn finite(&self, column: &str) -> Vec<f64> {
        self.table.floats(column).unwrap_or_default().into_iter().filter(|x| x.is_finite()).collect()
    }

    fn worst(&self, column: &str) -> String {
        let worst = self.finite(column).into_iter().map(f64::abs).reduce(f64::max);
        worst.map_or_else(|| "n/a".to_owned(), |worst| significant(worst, 2))
    }

    fn smallest_margin(&self) -> String {
        let smallest = self.finite("smallest_margin").into_iter().reduce(f64::min);
        smallest.map_or_else(|| "n/a".to_owned(), |margin| quantity(margin, "m", 2))
    }

    fn total(&self, column: &str) -> String {
        // Whole numbers far below 2^53: the sum is exact in any order.
        let total: f64 = self.finite(column).iter().sum();
        number::count(total as u64)
    }

    fn largest(&self, column: &str) -> String {
        number::count(self.finite(column).into_iter().fold(0.0, f64::max) as u64)
    }
}
