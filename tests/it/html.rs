//! The study as one HTML file: whole, closed in itself, and only what the study says as text.

use std::fs;

use crate::desk::{Desk, STOP, shotdamp};

/// The file, written by a command with these arguments before `report`.
fn written(desk: &Desk, name: &str, before: &[&str]) -> String {
    let file = desk.layout.path(name);
    let said = shotdamp(desk, &[before, &["report", "--html", file.to_str().unwrap()]].concat());
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    fs::read_to_string(file).unwrap()
}

#[test]
fn one_file_holds_every_page_figure_and_entry_and_asks_for_nothing() {
    let desk = Desk::new();
    assert_eq!(shotdamp(&desk, &["run", "--quiet"]).err, "");
    let html = written(&desk, "study.html", &[]);
    for id in ["study", "verdicts", "ch3-gap", "ch3-stop", "ch3-stop/at-two", "assumptions/gravity", "tolerances"] {
        assert!(html.contains(&format!(" id=\"{id}\"")), "{id}");
    }
    assert_eq!(
        html.matches("<tr data-verdict=").count(),
        shotdamp(&desk, &["check", "--json"]).out.matches("\"as_expected\"").count()
    );
    // A sketch and a figure of each of the two, and all numbers.
    assert_eq!(html.matches("<figure><svg").count(), 5);
    assert!(html.contains("data-name=") && html.contains("data-frame="));
    for asks in [" src=", "href=\"http", "url(", "@import", "<link rel=\"stylesheet", "<img", "xlink"] {
        assert!(!html.contains(asks), "{asks}");
    }
    assert!(written(&desk, "again.html", &["--jobs", "1"]) == html, "the same bytes on one thread");
    // Figures that are not on disk are drawn for it, the same.
    fs::remove_dir_all(desk.layout.path("reports/ch3")).unwrap();
    assert!(written(&desk, "drawn.html", &[]) == html, "the same bytes without figures on disk");
}

#[test]
fn a_file_of_missing_tables_is_announced() {
    let desk = Desk::new();
    assert_eq!(shotdamp(&desk, &["run", "--quiet", "ch3-gap"]).err, "");
    let file = desk.layout.path("study.html");
    let said = shotdamp(&desk, &["report", "--html", file.to_str().unwrap()]);
    assert_eq!(said.code, 0);
    let warning = "warning: 1 of 2 experiments has no table that is up to date: its numbers and figures are not in the file; `shotdamp run` makes it\n";
    assert_eq!(said.err, warning);
}

#[test]
fn what_a_study_says_is_never_markup() {
    let desk = Desk::new();
    let hostile = "\"<script>alert(1)</script> </title> {body} <b onclick=alert(1)>x\"";
    desk.put("experiments/ch3/ch3-stop.yaml", &STOP.replace("Limit stop", hostile).replace("Two curves.", hostile));
    assert_eq!(shotdamp(&desk, &["run", "--quiet"]).err, "");
    let html = written(&desk, "study.html", &[]);
    assert_eq!(html.matches("<script").count(), 2, "the program's own");
    assert!(!html.contains("<b onclick"));
    assert!(html.contains("{body}"), "text that looks like a place to fill stays");
}

#[test]
fn what_has_not_been_run_is_named_in_its_place() {
    let desk = Desk::new();
    let file = desk.layout.path("study.html");
    let said = shotdamp(&desk, &["report", "--html", file.to_str().unwrap()]);
    assert!(said.code == 0 && said.err.starts_with("warning: 2 of 2 experiments have no table"), "{}", said.err);
    let html = fs::read_to_string(file).unwrap();
    assert!(html.contains("not drawn, as there is no result yet"), "{html}");
}
