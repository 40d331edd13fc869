//! Reports: whole pages held against the files in `golden/`, and what must hold for any of them.
//!
//! After a wanted change, `GOLDEN=write cargo test` writes the files anew.

use std::collections::BTreeMap;

use shotdamp::experiment::{AboutStudy, AssumptionValue, Finding, value_in_words};
use shotdamp::reference::{Comparison, Judged, Kind, Price, PrintedUnit, Role, Verdict};
use shotdamp::report::{
    AccuracyLinks, AssumptionView, ExperimentView, FigureView, PageView, assumptions as assumptions_page, index,
    overview_svg, page, strip_svg, summary, tolerances,
};
use shotdamp::scene::EffectUse;
use shotdamp::study::{Heading, Machine};
use shotdamp::table::Table;
use shotdamp::text::number::{compact, quantity, signed, significant, with_uncertainty};
use shotdamp::text::words;

use crate::made_up::{limit_stop, limit_stop_table};

fn golden(name: &str, text: &str) {
    let path = format!("{}/tests/it/golden/{name}", env!("CARGO_MANIFEST_DIR"));
    if std::env::var_os("GOLDEN").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(kept == text, "{name} differs from what the report gives now:\n{text}");
}

fn entry(id: &str, verdict: Verdict) -> Judged {
    Judged {
        id: format!("ch3-limit-stop/{id}"),
        experiment: "ch3-limit-stop".into(),
        kind: Kind::Claim,
        statement: "Both curves have the same maximum at the same f′".into(),
        place: "s. 3.6.3, Fig. 18".into(),
        verdict,
        expected: verdict,
        found: "holds: 3.376 at f′ = 2.63 in both".into(),
        no_table: None,
        comparison: None,
        parts: Vec::new(),
        fit: None,
        explanation: String::new(),
        blocked_by: Vec::new(),
        printed_unit: PrintedUnit::default(),
        tolerance_reason: None,
        robust: Some((5, 6)),
        moved: Vec::new(),
        price: Price { rows: 122, runs: 402, events: 61_180 },
        motion: None,
        role: Role::Neither,
    }
}

/// One entry of each verdict, one of them a surprise.
fn judged() -> Vec<Judged> {
    let parting = Judged {
        kind: Kind::Number,
        statement: "The curves part near f′ = 2".into(),
        found: "2.13, +6.5 % of 2".into(),
        comparison: Some(Comparison {
            simulated: 2.131_245,
            published: 2.0,
            u_num: 0.012,
            u_input: 0.31,
            u_data: 0.5,
            spread: 0.0,
            tolerance_by_hand: Some(0.3),
            scale: None,
        }),
        tolerance_reason: Some("\"approximately\": the text rounds to whole numbers | or coarser".into()),
        explanation: "The stop length was chosen by this number.".into(),
        role: Role::Fitted,
        ..entry("parting", Verdict::Fitted)
    };
    let limit = Judged {
        statement: "The curve with stop tends to a higher limit".into(),
        found: "1.004 with, 1.015 without".into(),
        role: Role::HeldOut,
        explanation: "At f′ = 10 it does, s. 3.6.3 says no more. Beyond f′ = 500 the order turns.".into(),
        ..entry("limit", Verdict::Differs)
    };
    let peak = Judged {
        kind: Kind::Number,
        statement: "ψ is 1.516".into(),
        found: "1.5603, +2.9 % of 1.516".into(),
        expected: Verdict::Reproduced,
        comparison: Some(Comparison {
            simulated: 1.560_3,
            published: 1.516,
            u_num: 1e-13,
            u_input: 0.004,
            u_data: 0.0005,
            spread: 0.0,
            tolerance_by_hand: None,
            scale: None,
        }),
        robust: None,
        moved: Vec::new(),
        ..entry("peak", Verdict::Differs)
    };
    vec![entry("same-maximum", Verdict::Reproduced), parting, limit, peak]
}

fn assumptions() -> Vec<AssumptionView> {
    vec![
        AssumptionView {
            name: "stop_length".into(),
            value: value_in_words("m", &AssumptionValue::Number(0.06)),
            has_range: false,
            reason: "With 60 mm the curves part\nwhere the text says.".into(),
            used_by: vec!["ch3-limit-stop/parting".into(), "ch3-limit-stop/limit".into(), "ch3-gap/order".into()],
            fitted_to: vec!["ch3-limit-stop/parting".into()],
        },
        AssumptionView {
            name: "gravity".into(),
            value: value_in_words("m/s²", &AssumptionValue::Number(9.81)),
            has_range: true,
            reason: "The usual rounding.".into(),
            used_by: Vec::new(),
            fitted_to: Vec::new(),
        },
    ]
}

fn about() -> AboutStudy {
    let chapters = BTreeMap::from([(3, "one mass, one damper".to_owned())]);
    let about = "New simulations of a published study of particle impact dampers, compared with the numbers and claims of its text.";
    AboutStudy { about: Some(about.into()), chapters, ..AboutStudy::default() }
}

fn effects() -> Vec<EffectUse> {
    vec![
        EffectUse { name: "gravity", in_force: 122, cases: 122, why_not: "" },
        EffectUse { name: "limit stop", in_force: 61, cases: 122, why_not: "no limit stop is named" },
        EffectUse { name: "soft walls", in_force: 0, cases: 122, why_not: "the walls are rigid" },
    ]
}

fn figures() -> Vec<FigureView> {
    vec![FigureView {
        link: "ch3-limit-stop.png".into(),
        caption: "Velocity ratio ψ against f′, with and without stop.".into(),
        missing: None,
    }]
}

fn page_of(table: Option<&Table>, judged: &[Judged]) -> String {
    page(&PageView {
        experiment: &limit_stop(),
        table,
        motions: None,
        judged,
        not_judged: &[],
        assumptions: &assumptions(),
        effects: &effects(),
        figures: &figures(),
        table_name: "results/ch3-limit-stop.parquet",
        accuracy: Some(AccuracyLinks { page: "../accuracy/ch3-limit-stop.md".into() }),
        to_reports: "../",
    })
}

#[test]
fn a_page_tells_a_vibration_engineer_all_about_one_experiment() {
    golden("page.md", &page_of(Some(&limit_stop_table()), &judged()));
}

#[test]
fn the_index_tells_the_whole_study_at_a_glance() {
    let experiment = limit_stop();
    let judged = judged();
    let view = ExperimentView {
        experiment: Heading::of(&experiment),
        judged: &judged,
        seconds: Some(12.3),
        motions: None,
        page: "ch3/ch3-limit-stop.md".into(),
    };
    let machine = Machine {
        processor: "a processor".into(),
        threads: 2,
        system: "linux, x86_64".into(),
        build: "release build".into(),
    };
    golden("strip.svg", &strip_svg(std::slice::from_ref(&view)));
    golden("overview.svg", &overview_svg(std::slice::from_ref(&view)));
    golden("tolerances.md", &tolerances(std::slice::from_ref(&view)));
    golden("index.md", &index(&about(), std::slice::from_ref(&view), &[("Speed", "speed.md")], Some(&machine)));
}

#[test]
fn a_conclusion_stands_as_far_as_its_entries_do() {
    let judged = judged();
    let view = ExperimentView {
        experiment: Heading::of(&limit_stop()),
        judged: &judged,
        seconds: None,
        motions: None,
        page: "ch3/ch3-limit-stop.md".into(),
    };
    let agree = |one: &&Judged| matches!(one.verdict, Verdict::Reproduced);
    let good: Vec<String> = judged.iter().filter(agree).map(|one| one.id.clone()).collect();
    let bad = judged.iter().find(|one| one.verdict == Verdict::Differs).unwrap();
    let bad_ones: Vec<String> =
        judged.iter().filter(|one| one.verdict == Verdict::Differs).map(|one| one.id.clone()).collect();
    let finding = |says: &str, entries: Vec<String>| Finding { says: says.into(), entries };
    let about = AboutStudy {
        findings: vec![
            finding("Good.", vec![good[0].clone()]),
            finding("Mixed.", vec![good[0].clone(), bad.id.clone()]),
            finding("Worse.", [&good[..1], &bad_ones].concat()),
            finding("Bad.", vec![bad.id.clone()]),
            finding("Misspelt.", vec!["ch3-limit-stop/partng".into()]),
        ],
        ..about()
    };
    let index = index(&about, std::slice::from_ref(&view), &[], None);
    let row = |says: &str| index.lines().find(|line| line.starts_with(&format!("| {says}"))).unwrap_or_default();
    assert!(row("Good.").contains("**stands** [●](ch3/ch3-limit-stop.md#entry-"), "{index}");
    assert!(row("Mixed.").contains("**stands in part**, 1 of 2 [●]"), "{index}");
    // More differ than agree.
    assert!(bad_ones.len() > 1 && row("Worse.").contains("**mostly does not stand**, 1 of "), "{index}");
    assert!(row("Bad.").contains("**does not stand** [✕]"), "{index}");
    let why = bad.explanation.split(". ").next().unwrap();
    assert!(row("Bad.").contains(why.trim_end_matches('.')), "the reason stands beside it: {index}");
    assert!(row("Misspelt.").contains("no entry `ch3-limit-stop/partng`"), "{index}");
}

#[test]
fn a_page_of_which_little_is_decided_draws_no_conclusion_from_that() {
    let of = |counts: [(Verdict, usize); 3]| {
        let each = counts.into_iter().flat_map(|(verdict, count)| std::iter::repeat_n(verdict, count));
        page_of(None, &each.map(|verdict| entry("one", verdict)).collect::<Vec<_>>())
    };
    let few = of([(Verdict::Reproduced, 1), (Verdict::Differs, 2), (Verdict::Blocked, 10)]);
    let line = "**In short.** Mostly undecided: of 13 statements, 1 agrees, 2 differ, 10 blocked.";
    assert!(few.contains(line), "{few}");
    let none = of([(Verdict::Differs, 2), (Verdict::Undecidable, 6), (Verdict::Blocked, 5)]);
    assert!(none.contains("**In short.** Mostly undecided: of 13 statements, 0 agree, 2 differ"), "{none}");
    let half = of([(Verdict::Reproduced, 1), (Verdict::Differs, 2), (Verdict::Blocked, 3)]);
    assert!(half.contains("**In short.** Mostly does not stand: of 6 statements"), "{half}");
}

#[test]
fn assumptions_have_a_page_of_their_own() {
    golden("assumptions.md", &assumptions_page(&assumptions()));
}

#[test]
fn the_console_shows_what_is_unexpected_in_full() {
    let (one, other) = (judged(), [entry("same-maximum", Verdict::Reproduced)]);
    let text = summary(&[("ch3-limit-stop", &one), ("ch3-gap", &other)]);
    assert!(!text.contains('\u{1b}'), "no colours: {text}");
    golden("console.txt", &text);

    let calm = summary(&[("ch3-gap", &other)]);
    assert!(calm.ends_with("1 entry: 1 reproduced; all as expected.\n"), "{calm}");
}

#[test]
fn missing_is_never_as_expected() {
    let missing = [Judged { found: "the table is stale".into(), ..entry("peak", Verdict::Missing) }];
    assert!(summary(&[("ch3-limit-stop", &missing)]).contains("1 not as expected"));
    let text = page_of(None, &missing);
    assert!(text.contains("**? missing**") && text.contains("has not been run"), "{text}");
    assert!(text.contains("the table is stale"), "{text}");
}

#[test]
fn a_failed_run_is_told_with_its_reason() {
    let mut table = limit_stop_table();
    for column in &mut table.columns {
        if let (true, shotdamp::table::Data::Text(cells)) = (column.name == "failure", &mut column.data) {
            cells[3] = "too many events in one cycle".into();
        }
    }
    let text = page_of(Some(&table), &[]);
    assert!(text.contains("1 run: too many events in one cycle"), "{text}");
}

#[test]
fn a_page_gives_the_first_sentence_of_the_reason_before_all_else() {
    let one = [Judged {
        explanation: "Only Fig. 18 and s. 3.6 say so. The rest is lost.".into(),
        ..entry("limit", Verdict::Blocked)
    }];
    let text = page_of(None, &one);
    assert!(text.contains("- Why: Only Fig. 18 and s. 3.6 say so.\n"), "{text}");
    assert!(text.find("- Why:") < text.find("!["), "before the figure: {text}");
}

#[test]
fn the_rule_of_agreement_is_said_once_and_is_the_one_that_judges() {
    let judged = judged();
    let experiment = limit_stop();
    let view = ExperimentView {
        experiment: Heading::of(&experiment),
        judged: &judged,
        seconds: None,
        motions: None,
        page: String::new(),
    };
    let index = index(&about(), &[view], &[], None);
    assert!(index.contains("The two agree if |E| ≤ 2 u_val. **± is 2 u_val**"), "{index}");
    let at = |deviation: f64| {
        let comparison = judged[3].comparison.unwrap();
        comparison.verdict_of(comparison.published + deviation * comparison.u_val(), false)
    };
    assert_eq!((at(1.9), at(2.1)), (Verdict::Reproduced, Verdict::Differs));
}

#[test]
fn another_number_has_the_verdict_that_it_would_have_in_the_place_of_the_one_that_came_out() {
    let peak = judged()[3].comparison.unwrap();
    assert_eq!(peak.verdict_of(peak.published, true), Verdict::Fitted);
    // An instant some fifty seconds after the start is known to 0.1 s: much for an event that comes every 0.2 s.
    let instant = Comparison { published: 52.55, u_input: 0.05, scale: Some(0.2), ..peak };
    assert_eq!(instant.verdict_of(52.6, false), Verdict::Blocked);
    assert_eq!(Comparison { scale: None, ..instant }.verdict_of(52.6, false), Verdict::Reproduced);
}

#[test]
fn a_tolerance_by_hand_stands_beside_the_verdict() {
    let row = page_of(None, &judged()).lines().find(|line| line.contains("entry-parting")).unwrap().to_owned();
    assert!(row.contains("tolerance set by hand: ±0.3"), "{row}");
    // The study prints mm/s, the table holds m/s.
    let mut judged = judged();
    for one in judged.iter_mut().filter(|one| one.id.ends_with("parting")) {
        one.printed_unit = PrintedUnit { symbol: "mm/s".into(), worth: 1e-3 };
    }
    let page = page_of(None, &judged);
    let row = page.lines().find(|line| line.contains("entry-parting")).unwrap();
    assert!(row.contains("tolerance set by hand: ±300 mm/s"), "{row}");
    assert!(page.contains("±300 mm/s, "), "{page}");
}

#[test]
fn the_headline_separates_numbers_from_claims() {
    let (experiment, judged) = (limit_stop(), judged());
    let view = ExperimentView {
        experiment: Heading::of(&experiment),
        judged: &judged,
        seconds: None,
        motions: None,
        page: String::new(),
    };
    let text = index(&about(), &[view], &[], None);
    let counts = "**2 numbers**: 1 fitted, 1 differs. **2 claims**: 1 reproduced, 1 differs. **Used in fits**: 1 entry, of which 1 agrees \
                  (fitted). **Held out** of all fits: 0 of 1 agree.";
    assert!(text.contains(counts), "{text}");
}

#[test]
fn a_page_counts_all_entries_that_were_used_in_fits_and_those_of_them_that_agree() {
    let used = |verdict: Verdict| Judged { role: Role::Fitted, ..entry("a", verdict) };
    let plain = entry("b", Verdict::Reproduced);
    let (fitted, differs, left_out) = (
        used(Verdict::Fitted),
        used(Verdict::Differs),
        Judged { role: Role::CrossValidated, ..entry("c", Verdict::Fitted) },
    );
    let lead =
        |judged: &[Judged]| page_of(None, judged).lines().find(|line| line.contains("In short")).unwrap().to_owned();
    let both = lead(&[plain.clone(), fitted.clone(), left_out, differs.clone()]);
    assert!(
        both.contains(
            "of 2 statements, 1 agrees, 1 differs; of 3 used in fits 2 more agree (fitted), which proves nothing."
        ),
        "{both}"
    );
    let agrees = lead(&[plain.clone(), fitted]);
    assert!(
        agrees
            .contains("of 1 statement, 1 agrees; 1 more agrees, but was used in fits (fitted), which proves nothing."),
        "{agrees}"
    );
    let none_agrees = lead(&[plain, differs.clone(), differs]);
    assert!(none_agrees.contains("of 3 statements, 1 agrees, 2 differ; 2 of them were used in fits."), "{none_agrees}");
}

#[test]
fn no_page_links_to_a_file_that_is_not_committed() {
    let text = page_of(Some(&limit_stop_table()), &judged());
    assert!(!text.contains(".parquet)") && text.contains("`shotdamp run ch3-limit-stop` writes `results/"), "{text}");
}

#[test]
fn numbers_keep_their_significant_digits() {
    for (value, digits, text) in [
        (1.2e-14, 2, "1.2e-14"),
        (0.0123, 3, "0.0123"),
        (1234.0, 4, "1\u{202f}234"),
        (123_456.7, 3, "123\u{202f}000"),
        (9.999, 3, "10.0"),
        (0.000_099_99, 2, "0.00010"),
        (-0.5, 2, "−0.50"),
        (1e6, 2, "1.0e6"),
        (-3.0e300, 1, "−3e300"),
        (5e-324, 2, "4.9e-324"),
        (0.0, 3, "0"),
        (f64::NAN, 3, "n/a"),
        (f64::NEG_INFINITY, 3, "−∞"),
    ] {
        assert_eq!(significant(value, digits), text);
    }
    assert_eq!(compact(50.0, 4), "50");
    assert_eq!(compact(1.516, 12), "1.516");
    assert_eq!(signed(0.0443, 2), "+0.044");
    assert_eq!(signed(-0.0443, 2), "−0.044");
}

#[test]
fn a_value_stops_where_its_uncertainty_stops() {
    for (value, uncertainty, texts) in [
        (628.45, 65.2, ("628", "65")),
        (3.6332, 10.0, ("3.6", "10")),
        (52.327_1, 0.010_1, ("52.327", "0.010")),
        (1.538_99, 0.78, ("1.54", "0.78")),
        (0.569_68, 0.44, ("0.57", "0.44")),
        (-0.5, 1e-14, ("−0.5000000", "1.0e-14")),
    ] {
        let (value, uncertainty) = with_uncertainty(value, uncertainty);
        assert_eq!((value.as_str(), uncertainty.as_str()), texts);
    }
}

#[test]
fn units_take_the_prefix_an_engineer_would_write() {
    assert_eq!(quantity(0.06, "m", 3), "60 mm");
    assert_eq!(quantity(1e-3, "s", 3), "1 ms");
    assert_eq!(quantity(1e-5, "s", 3), "10 µs");
    assert_eq!(quantity(3.2e-9, "m", 2), "3.2 nm");
    assert_eq!(quantity(4.2426, "N s/m", 3), "4.24 N s/m");
    assert_eq!(quantity(0.05, "", 3), "0.05");
    assert_eq!(words::of_solver("fixed_step_1e-5s"), "fixed step 10 µs");
    assert_eq!(words::of_solver("event_driven"), "event-driven");
}

#[test]
fn an_assumed_curve_is_told_by_its_ends() {
    let curve = AssumptionValue::Curve(vec![[0.7, 1.0], [3.0, 4.0], [7.6, 2.0]]);
    let description = value_in_words("N s/m", &curve);
    assert_eq!(description, "a curve through 3 points, 1 N s/m at 0.7 g to 2 N s/m at 7.6 g");
}
