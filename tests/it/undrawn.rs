//! A figure that has nothing to show any more: no old picture stays, and the page says why there is none.

use std::fs;

use crate::desk::{Desk, THREE_GAPS, shotdamp};

const FIGURE: &str = "figure: {x: gap_ratio, y: velocity_ratio, caption: Three points.}\n";
const FILE: &str = "experiments/ch3/ch3-drawn.yaml";

/// Three rows of what the figure draws.
fn drawn() -> String {
    THREE_GAPS.replace("rms_velocity", "velocity_ratio")
}

fn study() -> Desk {
    Desk::of_one(FILE, &(drawn() + FIGURE))
}

/// Names of the pictures of the figure.
fn pictures(desk: &Desk) -> Vec<&'static str> {
    let names = ["ch3-drawn.png", "ch3-drawn.svg"];
    names.into_iter().filter(|name| desk.layout.path("reports/ch3").join(name).exists()).collect()
}

fn page(desk: &Desk) -> String {
    String::from_utf8(desk.bytes("reports/ch3/ch3-drawn.md")).unwrap()
}

fn says_that_there_is_none(desk: &Desk, why: &str) {
    assert_eq!(pictures(desk), [""; 0]);
    let page = page(desk);
    assert!(!page.contains("](ch3-drawn.png)"), "{page}");
    assert!(page.contains("**Not drawn:** Three points. Figure ") && page.contains("has nothing to draw"), "{page}");
    assert!(page.contains(why), "{page}");
    // The same rule for who looks whether the committed pages are up to date.
    let said = shotdamp(desk, &["check", "--reports"]);
    assert!(!said.err.contains("ch3-drawn.md") && !said.err.contains("nothing writes it"), "{}", said.err);
}

#[test]
fn without_a_force_there_is_no_picture_and_with_one_there_is_again() {
    let desk = study();
    assert_eq!(shotdamp(&desk, &["run"]).code, 0);
    assert_eq!(pictures(&desk).len(), 2);
    assert!(page(&desk).contains("![Three points.](ch3-drawn.png)"));
    desk.put(FILE, &(drawn().replace("force_ratio: 5", "force_ratio: 0") + FIGURE));
    for _ in 0..2 {
        let said = shotdamp(&desk, &["run"]);
        assert!(said.code == 2 && said.err.contains("has nothing to draw"), "{}", said.err);
        says_that_there_is_none(&desk, "neither run moves");
    }
    desk.put(FILE, &(drawn() + FIGURE));
    assert_eq!(shotdamp(&desk, &["run"]).code, 0);
    assert_eq!(pictures(&desk).len(), 2);
}

#[test]
fn where_all_rows_fail_no_picture_stays_and_none_is_linked() {
    for drawn_before in [true, false] {
        let desk = study();
        if drawn_before {
            assert_eq!(shotdamp(&desk, &["run"]).code, 0);
        }
        assert_eq!(shotdamp(&desk, &["run", "--force", "--row-limit", "1 events"]).code, 2);
        says_that_there_is_none(&desk, "stopped at the limit of 1 event");
    }
}

/// Also where the experiment was simulated again in the same run, or could not be drawn in between.
#[test]
fn a_figure_that_is_taken_out_takes_its_pictures_along() {
    for (before, after) in [("", ""), ("", "average: 9"), ("--row-limit", ""), ("--row-limit", "average: 9")] {
        let desk = study();
        assert_eq!(shotdamp(&desk, &["run"]).code, 0);
        if !before.is_empty() {
            // Some rows fail, others are drawn.
            shotdamp(&desk, &["run", "--force", before, "60 events"]);
        }
        let after = if after.is_empty() { drawn() } else { drawn().replace("average: 8", after) };
        desk.put(FILE, &after);
        let said = shotdamp(&desk, &["run"]);
        assert_eq!(said.code, 0, "{}", said.err);
        assert_eq!(pictures(&desk), [""; 0], "{before} {after}");
        assert_eq!(shotdamp(&desk, &["check", "--reports"]).code, 0);
    }
}

/// As in a study that was just cloned: its reports are there, and no record of what they were made from.
#[test]
fn a_picture_that_no_record_knows_goes_too() {
    let desk = study();
    assert_eq!(shotdamp(&desk, &["run"]).code, 0);
    fs::remove_dir_all(desk.layout.path("results")).unwrap();
    desk.put(FILE, &(drawn().replace("force_ratio: 5", "force_ratio: 0") + FIGURE));
    assert_eq!(shotdamp(&desk, &["run"]).code, 2);
    says_that_there_is_none(&desk, "neither run moves");
}
