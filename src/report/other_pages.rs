//! What benchmarks, tests and other commands write below `reports/`, and no run: measured times among them, which are never the
//! same again.

/// Pages, by title and name below `reports/`; pictures and data go by the name of their page.
pub(super) const PAGES: [(&str, &str); 6] = [
    ("Speed", "speed.md"),
    ("What accuracy costs", "accuracy.md"),
    ("Peers", "accuracy/peers.md"),
    ("Peers on hard sequences of events", "accuracy/peers-events.md"),
    ("Peers on one periodic motion", "accuracy/peers-orbit.md"),
    ("Hard cases", "hard-cases.md"),
];
/// Folders with a page for each experiment or calibration.
const FOLDERS: [&str; 2] = ["accuracy/", "calibrations/"];
/// What `run --times` writes.
const TIMES: &str = "times.json";

/// True for a file, by its name below `reports/`, that no run writes.
pub(super) fn is_written_otherwise(name: &str) -> bool {
    let of_page = |(_, page): &(&str, &str)| name.starts_with(page.trim_end_matches("md"));
    name == TIMES || FOLDERS.iter().any(|folder| name.starts_with(folder)) || PAGES.iter().any(of_page)
}
