//! `check` in a CI: JUnit, GitHub, JSON, accepted verdicts, committed reports.

use std::collections::BTreeSet;
use std::fs;

use roxmltree::Document;
use shotdamp::reference::{Comparison, Judged, Kind, Price, PrintedUnit, Role, Verdict, accept, parse_reference};
use shotdamp::report::{CheckView, CheckedEntry, SUMMARY_LIMIT, Trouble, annotations, json, junit, step_summary};
use shotdamp::text::number::count;

use crate::desk::{Desk, GAP, GAP_REFERENCE, command, said, shotdamp, simulated};

fn judged(id: &str, verdict: Verdict, expected: Verdict) -> Judged {
    let (experiment, _) = id.split_once('/').unwrap();
    Judged {
        id: id.into(),
        experiment: experiment.into(),
        kind: Kind::Claim,
        statement: "ψ < 2 & \"more\"".into(),
        place: "s. 3.6.3, Fig. 18".into(),
        verdict,
        expected,
        found: "1.56, 100 % of it: a, b".into(),
        no_table: None,
        comparison: None,
        parts: Vec::new(),
        fit: None,
        explanation: "Nobody\nknows.".into(),
        blocked_by: Vec::new(),
        printed_unit: PrintedUnit::default(),
        tolerance_reason: None,
        robust: None,
        moved: Vec::new(),
        price: Price::default(),
        motion: None,
        role: Role::Neither,
    }
}

fn off_by(deviation: f64) -> Option<Comparison> {
    Some(Comparison {
        simulated: 2.0 + 0.01 * deviation,
        published: 2.0,
        u_num: 0.0,
        u_input: 0.0,
        u_data: 0.01,
        spread: 0.0,
        tolerance_by_hand: None,
        scale: None,
    })
}

fn view<'a>(judged: &'a [Judged], troubles: Vec<Trouble>) -> CheckView<'a> {
    let entries =
        judged.iter().zip(2..).map(|(judged, line)| CheckedEntry { judged, file: "reference/ch3/x.yaml", line });
    CheckView { entries: entries.collect(), troubles }
}

fn trouble(message: &str) -> Trouble {
    Trouble { file: "experiments/a,b.yaml".into(), line: Some(7), message: message.into() }
}

/// One of each kind, in two experiments.
fn one_of_each() -> Vec<Judged> {
    use Verdict::{Blocked, Differs, Fitted, Missing, Reproduced, Undecidable};
    vec![
        judged("ch3-a/as-published", Reproduced, Reproduced),
        judged("ch3-a/known", Differs, Differs),
        judged("ch3-a/fitted", Fitted, Fitted),
        judged("ch3-a/open", Blocked, Blocked),
        judged("ch3-a/chaos", Undecidable, Undecidable),
        Judged { comparison: off_by(12.0), ..judged("ch3-b/off", Differs, Reproduced) },
        judged("ch3-b/better", Reproduced, Differs),
        judged("ch3-b/gone", Missing, Reproduced),
        judged("ch3-b/stuck", Blocked, Reproduced),
    ]
}

#[test]
fn junit_tells_failures_from_errors_and_from_what_cannot_be_decided() {
    let judged = one_of_each();
    let xml = junit(&view(&judged, vec![trouble("bad <tag>\u{1}\u{1b}[31m"), trouble("and worse")]));
    let document = Document::parse(&xml).unwrap();
    let cases: Vec<_> = document.descendants().filter(|node| node.has_tag_name("testcase")).collect();
    let names: BTreeSet<_> = cases.iter().map(|case| case.attribute("name").unwrap()).collect();
    assert_eq!((cases.len(), names.len()), (11, 11), "every name once");

    let outcome = |name: &str| {
        let case = cases.iter().find(|case| case.attribute("name") == Some(name)).unwrap();
        case.first_element_child().map(|child| (child.tag_name().name().to_owned(), child.text().unwrap().to_owned()))
    };
    assert_eq!(outcome("ch3-a/as-published"), None);
    for (name, kind) in [
        ("ch3-a/known", "system-out"),
        ("ch3-a/fitted", "system-out"),
        ("ch3-a/open", "skipped"),
        ("ch3-a/chaos", "skipped"),
        ("ch3-b/off", "failure"),
        ("ch3-b/better", "failure"),
        ("ch3-b/stuck", "failure"),
        ("ch3-b/gone", "error"),
        ("experiments/a,b.yaml", "error"),
        ("experiments/a,b.yaml#2", "error"),
    ] {
        assert_eq!(outcome(name).unwrap().0, kind, "{name}");
    }
    let (_, off) = outcome("ch3-b/off").unwrap();
    for part in [
        "expected reproduced, came differs",
        "ψ < 2 & \"more\"",
        "s. 3.6.3, Fig. 18",
        "E = +0.120, that is 12 u_val; 2 u_val are allowed",
        "shotdamp run --force ch3-b",
    ] {
        assert!(off.contains(part), "{part}\n{off}");
    }
    assert_eq!(outcome("experiments/a,b.yaml").unwrap().1, "bad <tag>??[31m");

    // The counts are those of the cases, suite by suite.
    for suite in document.descendants().filter(|node| node.has_tag_name("testsuite")) {
        let count = |kind: &str| suite.descendants().filter(|node| node.has_tag_name(kind)).count().to_string();
        for (attribute, kind) in
            [("tests", "testcase"), ("failures", "failure"), ("errors", "error"), ("skipped", "skipped")]
        {
            assert_eq!(suite.attribute(attribute).unwrap(), count(kind), "{attribute}");
        }
    }
}

#[test]
fn github_gets_the_nine_worst_and_a_count_of_the_rest() {
    let mut judged = one_of_each();
    for deviation in 3..12 {
        let id = format!("ch3-c/{deviation}-off");
        let one = self::judged(&id, Verdict::Differs, Verdict::Reproduced);
        judged.push(Judged { comparison: off_by(f64::from(deviation)), ..one });
    }
    let description = annotations(&view(&judged, vec![trouble("100 % wrong\r\nhere: x")]));
    let lines: Vec<&str> = description.lines().collect();
    assert_eq!(lines.len(), 10, "GitHub shows no more than ten of a step");
    assert_eq!(
        lines[0],
        "::error file=experiments/a%2Cb.yaml,line=7,title=this file cannot be used::100 %25 wrong%0D%0Ahere: x"
    );
    assert!(lines[1].starts_with("::error file=reference/ch3/x.yaml,line=9,title=ch3-b/gone%3A missing%2C expected"));
    assert!(lines[2].contains("ch3-b/off%3A differs"), "the farthest first: {}", lines[2]);
    assert!(lines[3].contains("ch3-c/11-off") && lines[8].contains("ch3-c/6-off"), "{description}");
    assert!(lines[9].starts_with("::error title=5 more not as expected::"), "{}", lines[9]);
}

#[test]
fn a_step_summary_says_what_it_cut() {
    let judged: Vec<Judged> = (0..6000)
        .map(|index| {
            let one = self::judged(&format!("ch3-c/entry-{index}"), Verdict::Differs, Verdict::Reproduced);
            Judged { found: "far off ".repeat(30), ..one }
        })
        .collect();
    let text = step_summary(&view(&judged, Vec::new()), SUMMARY_LIMIT);
    assert!(text.len() <= SUMMARY_LIMIT && text.len() > SUMMARY_LIMIT - 2048, "{}", text.len());
    let shown = text.matches("\n- **`").count();
    let cut =
        format!("Cut to the limit of a summary: {} entries that are not as expected.", count(6000 - shown as u64));
    assert!(text.contains(&cut), "{shown} shown: {}", &text[text.len() - 300..]);
    assert!(step_summary(&view(&judged, Vec::new()), 100).len() <= 100, "whatever is left");

    let judged = one_of_each();
    let whole = step_summary(&view(&judged, vec![trouble("``` a fence ```")]), SUMMARY_LIMIT);
    assert!(!whole.contains("Cut") && whole.contains("````text\n``` a fence ```\n````"), "{whole}");
    assert!(whole.contains("| `ch3-b` | 1 |"), "{whole}");
}

#[test]
fn the_command_serves_a_ci() {
    let desk = simulated();
    desk.put("reference/ch3/ch3-gap.yaml", &GAP_REFERENCE.replace("increasing", "decreasing"));
    desk.put("experiments/ch3/ch3-bad.yaml", &GAP.replace("gap_ratio: swept", "gap: 5 s"));
    let (file, summary) = (desk.layout.path("out/junit.xml"), desk.layout.path("summary.md"));
    fs::write(&summary, "What the step said before.\n").unwrap();
    let mut ci = command(&desk, &["check", "--github", "--junit", file.to_str().unwrap()]);
    ci.env("GITHUB_STEP_SUMMARY", &summary);
    let ci = said(ci);
    assert_eq!(ci.code, 2);
    assert!(ci.out.contains("\n    again      shotdamp run --force ch3-gap\n"), "on the console too: {}", ci.out);
    let annotation = "\n::error file=reference/ch3/ch3-gap.yaml,line=3,title=ch3-gap/grows%3A differs";
    assert!(ci.out.contains(annotation), "{}", ci.out);
    assert!(ci.out.contains("\n::error file=experiments/ch3/ch3-bad.yaml,line="), "{}", ci.out);
    let xml = fs::read_to_string(&file).unwrap();
    let document = Document::parse(&xml).unwrap();
    let all = document.root_element();
    assert_eq!((all.attribute("failures"), all.attribute("errors")), (Some("1"), Some("1")));
    let summary = fs::read_to_string(&summary).unwrap();
    assert!(summary.starts_with("What the step said before.\n## Verdicts\n"), "{summary}");

    let document = shotdamp(&desk, &["check", "--json", "--self-test"]);
    assert_eq!(document.code, 2);
    let document: serde_json::Value = serde_json::from_str(&document.out).unwrap();
    let grows = &document["entries"][0];
    assert_eq!((&grows["id"], &grows["verdict"]), (&"ch3-gap/grows".into(), &"differs".into()));
    assert_eq!((&grows["expected"], &grows["as_expected"]), (&"reproduced".into(), &false.into()));
    let value = &document["entries"][1]["deviations"][0];
    assert!(value["error"].is_f64() && value["u_val"].is_f64() && value["in_u_val"].is_f64(), "{value}");
    assert_eq!(document["unusable"][0]["file"], "experiments/ch3/ch3-bad.yaml");
}

#[test]
fn json_is_read_by_programs_even_where_a_number_is_none() {
    let mut one = judged("ch3-a/x", Verdict::Missing, Verdict::Reproduced);
    one.comparison = off_by(f64::NAN);
    let document: serde_json::Value = serde_json::from_str(&json(&view(&[one], Vec::new()))).unwrap();
    assert!(document["entries"][0]["deviations"][0]["error"].is_null());
}

const LAYOUTS: &str = "\
# The numbers of section 3.
entries:
  - id: plain   # the first
    place: s. 3
    says: It is two.
    value: \"2\"
    from: {cell: {of: velocity_ratio, where: {force_ratio: 2}}}   # at two

  # Of the second a word.
  - id: known
    place: s. 3
    says: >-
      It is
      three.
    value: \"3\"
    from: {cell: {of: velocity_ratio, where: {force_ratio: 2}}}
    expected: differs        # since the finer sweep
    explanation: >-          # description at length
      The old reason,
      over two lines.

    tolerance: {relative: 0.1, reason: hand}
  - {id: flow, place: s. 3, says: Four., value: \"4\", from: {cell: {of: velocity_ratio}}}
  - id: short
    place: s. 3
    says: Five.
    value: \"5\"
    from: {cell: {of: velocity_ratio}}
    explanation: one line   # kept
# The end.
";

#[test]
fn accepting_a_verdict_changes_two_keys_and_nothing_else() {
    let file = parse_reference("ch3-x", "it.yaml", LAYOUTS).unwrap();
    let accepted = |id: &str, verdict, expected, reason: &str| {
        accept(&file, LAYOUTS, &judged(&format!("ch3-x/{id}"), verdict, expected), reason)
    };
    use Verdict::{Differs, Missing, Reproduced, Undecidable};
    let plain = accepted("plain", Differs, Reproduced, "The study: rounds # \"down\".").unwrap();
    let anchor = "{force_ratio: 2}}}   # at two\n";
    let added = "    expected: differs\n    explanation: >-\n      The study: rounds # \"down\".\n";
    assert_eq!(plain, LAYOUTS.replace(anchor, &format!("{anchor}{added}")));

    let known = accepted("known", Undecidable, Differs, "Chaos.").unwrap();
    let expected = LAYOUTS
        .replace("expected: differs        # since", "expected: undecidable        # since")
        .replace("      The old reason,\n      over two lines.\n", "      Chaos.\n");
    assert_eq!(known, expected);

    let mut blocked = judged("ch3-x/plain", Verdict::Blocked, Reproduced);
    let waits = accept(&file, LAYOUTS, &blocked, "The gap decides.").unwrap_err().to_string();
    assert!(waits.contains("take `blocked_by` out of the entry"), "a claim waits, whatever comes out: {waits}");
    blocked.kind = Kind::Number;
    assert!(accept(&file, LAYOUTS, &blocked, "The gap decides.").unwrap().contains("    expected: blocked\n"));

    let flow = accepted("flow", Differs, Reproduced, "It: \"is\" so.").unwrap();
    let added = "{id: flow, expected: differs, explanation: \"It: \\\"is\\\" so.\", place";
    assert_eq!(flow, LAYOUTS.replace("{id: flow, place", added));

    let long = "word ".repeat(40);
    let short = accepted("short", Differs, Reproduced, &long).unwrap();
    assert!(short.contains("    explanation: >-   # kept\n      word word"), "{short}");
    assert!(short.contains("\n    expected: differs\n# The end.\n"), "{short}");
    assert!(short.lines().all(|line| line.chars().count() <= 120));

    let windows = LAYOUTS.replace('\n', "\r\n");
    let one = judged("ch3-x/known", Undecidable, Differs);
    assert_eq!(accept(&file, &windows, &one, "Chaos.").unwrap(), expected.replace('\n', "\r\n"));

    assert!(accepted("plain", Missing, Reproduced, "x").unwrap_err().to_string().contains("never an expected verdict"));
    assert!(accepted("plain", Reproduced, Reproduced, "x").unwrap_err().to_string().contains("as expected already"));
    assert!(accepted("plain", Differs, Reproduced, " \n").unwrap_err().to_string().contains("--reason"));
}

#[test]
fn an_accepted_verdict_is_expected_from_then_on() {
    let desk = simulated();
    let reference =
        GAP_REFERENCE.replace("increasing", "decreasing").replace("    claim", "    # A comment.\n    claim");
    desk.put("reference/ch3/ch3-gap.yaml", &reference);
    assert_eq!(shotdamp(&desk, &["check"]).code, 1);
    assert_eq!(shotdamp(&desk, &["check", "--accept", "ch3-gap/grows"]).code, 2, "not without a reason");
    assert_eq!(shotdamp(&desk, &["check", "--accept", "ch3-gap/typo", "--reason", "x"]).code, 2);
    let accepted = shotdamp(&desk, &["check", "--accept", "ch3-gap/grows", "--reason", "It grows."]);
    assert_eq!(accepted.out, "reference/ch3/ch3-gap.yaml: ch3-gap/grows expects differs now, was reproduced\n");
    let text = fs::read_to_string(desk.layout.path("reference/ch3/ch3-gap.yaml")).unwrap();
    assert_eq!(text, format!("{reference}    expected: differs\n    explanation: >-\n      It grows.\n"));
    assert_eq!(shotdamp(&desk, &["check"]).code, 0);
}

#[test]
fn committed_reports_are_those_that_would_be_generated() {
    let desk = simulated();
    desk.put("reports/speed.md", "measured, not generated");
    assert_eq!(shotdamp(&desk, &[]).code, 0);
    let same = shotdamp(&desk, &["check", "--reports"]);
    assert_eq!((same.code, same.err.as_str()), (0, ""));

    desk.put("reports/ch3/ch3-lost.md", "of an experiment that is gone");
    fs::remove_file(desk.layout.path("reports/ch3/ch3-gap.png")).unwrap();
    let page = String::from_utf8(desk.bytes("reports/ch3/ch3-stop.md")).unwrap();
    desk.put("reports/ch3/ch3-stop.md", &page.replacen("With and without.", "Polished.", 1));
    let mut png = desk.bytes("reports/ch3/ch3-stop.png");
    png[1000] ^= 1;
    fs::write(desk.layout.path("reports/ch3/ch3-stop.png"), png).unwrap();
    // Simulating alone does not renew them: a CI that has no results yet runs this first.
    assert_eq!(shotdamp(&desk, &["run", "--tables"]).code, 0);
    let description = shotdamp(&desk, &["check", "--reports"]);
    assert_eq!(description.code, 1);
    assert_eq!(
        description.err,
        "error: reports/ch3/ch3-gap.png: is not there\n\
         error: reports/ch3/ch3-lost.md: nothing writes it; remove it\n\
         error: reports/ch3/ch3-stop.md:38: differs first in this line\n    \
             committed  Polished.\n    generated  With and without.\n\
         error: reports/ch3/ch3-stop.png: differs from byte 1000 on\n"
    );
    assert_eq!(shotdamp(&Desk::new(), &["check", "--reports"]).code, 2, "without tables nothing can be said");
}

#[test]
fn the_reports_of_one_experiment_are_checked_without_those_of_others() {
    let desk = simulated();
    assert_eq!(shotdamp(&desk, &[]).code, 0);
    desk.put("reports/ch3/ch3-stop.md", "Polished.");
    desk.put("reports/README.md", "Polished.");
    let gap = shotdamp(&desk, &["check", "--reports", "ch3-gap"]);
    assert_eq!((gap.code, gap.err.as_str()), (0, ""));
    let stop = shotdamp(&desk, &["check", "--reports", "ch3-stop"]);
    assert!(stop.err.contains("ch3-stop.md:1: differs") && !stop.err.contains("README"), "{}", stop.err);

    // As in a study that was just cloned.
    fs::remove_dir_all(desk.layout.path("results")).unwrap();
    let all = shotdamp(&desk, &["check", "--reports"]).err;
    let line = "reports of ch3-gap, ch3-stop: there are no tables that are up to date; `shotdamp run` makes them\n";
    assert!(all.contains(line) && all.matches("up to date").count() == 1, "{all}");
    let gap = shotdamp(&desk, &["check", "--reports", "ch3-gap"]).err;
    assert!(gap.contains("`shotdamp run ch3-gap` makes it") && !gap.contains("ch3-stop"), "{gap}");
}

#[test]
fn a_run_says_which_experiments_mistakes_leave_out() {
    let desk = simulated();
    desk.put("experiments/ch3/ch3-gap.yaml", "title: [\n");
    desk.put("reference/ch3/ch3-stop.yaml", "entries: [\n");
    for arguments in [&["run", "ch3-*", "--dry-run"][..], &["run", "ch3-*"]] {
        let said = shotdamp(&desk, arguments);
        assert_eq!(said.code, 2);
        let left_out = "Left out, because of mistakes in their files: ch3-gap.\n";
        assert!(said.err.contains(left_out), "{}", said.err);
        assert!(said.err.ends_with("Not judged, because of mistakes in their references: ch3-stop.\n"), "{}", said.err);
    }
    let gap = shotdamp(&desk, &["run", "ch3-gap", "--dry-run"]);
    assert!(gap.out.is_empty() && gap.err.contains("Left out"), "{}{}", gap.out, gap.err);
}

#[test]
fn a_check_of_a_file_that_cannot_be_read_counts_no_entries() {
    let desk = simulated();
    desk.put("experiments/ch3/ch3-gap.yaml", "title: [\n");
    fs::remove_file(desk.layout.path("reference/ch3/ch3-gap.yaml")).unwrap();
    let said = shotdamp(&desk, &["check", "ch3-gap"]);
    assert_eq!((said.code, said.out.as_str()), (2, ""), "{}", said.err);
}

#[test]
fn a_blocked_entry_is_not_accepted_and_the_reason_is_what_it_lacks() {
    let desk = simulated();
    let entry = "    expected: blocked\n    blocked_by: [stop length]\n    explanation: Not stated.\n";
    desk.put("reference/ch3/ch3-gap.yaml", &format!("{GAP_REFERENCE}{entry}"));
    let said = shotdamp(&desk, &["check", "--accept", "ch3-gap/grows", "--reason", "So it is."]);
    assert!(said.code == 2, "{}", said.out);
    assert!(said.err.contains("take `blocked_by` out of the entry"), "{}", said.err);
}

#[test]
fn the_templates_for_a_ci_use_options_that_exist() {
    let help = shotdamp(&simulated(), &["check", "--help"]).out;
    for name in ["github.yml", "gitlab.yml"] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("ci-templates").join(name);
        let text = fs::read_to_string(path).unwrap();
        assert!(text.contains("shotdamp run") && text.contains("shotdamp check"), "{name}");
        let check = &text[text.find("shotdamp check").unwrap()..];
        let options = check.lines().take(2).flat_map(str::split_whitespace).filter(|word| word.starts_with("--"));
        let unknown: Vec<&str> = options.filter(|option| !help.contains(option)).collect();
        assert!(unknown.is_empty(), "{name}: {unknown:?}");
        // A version that is named, and tables that a red check does not throw away.
        assert!(text.contains("--tag \"$SHOTDAMP_TAG\""), "{name}");
        assert!(text.contains("cache/save@v4") || text.contains("when: always\n    paths:\n      - results"), "{name}");
        assert!(text.contains("if [ -f reports/verdicts.json ]"), "{name}: reports need not be committed");
    }
}

#[test]
fn the_summary_of_a_pull_request_starts_with_what_changed() {
    use shotdamp::report::{PULL_REQUEST_LIMIT, pull_request, read_json};
    let before = judged("ch3-a/x", Verdict::Reproduced, Verdict::Reproduced);
    let committed = read_json(&json(&view(std::slice::from_ref(&before), Vec::new()))).unwrap();
    let now = [judged("ch3-a/x", Verdict::Differs, Verdict::Reproduced)];
    let text = pull_request(&view(&now, Vec::new()), &committed);
    let (change, rest) = (text.find("`ch3-a/x`: reproduced → **differs**"), text.find("### Not as expected"));
    assert!(change.is_some() && change < rest, "{text}");
    let same = pull_request(&view(&[before], Vec::new()), &committed);
    assert!(same.contains("No verdict and no number changed."), "{same}");
    let many: Vec<Judged> =
        (0..3000).map(|n| judged(&format!("ch3-a/{n}"), Verdict::Differs, Verdict::Reproduced)).collect();
    assert!(pull_request(&view(&many, Vec::new()), &committed).len() <= PULL_REQUEST_LIMIT);
}
