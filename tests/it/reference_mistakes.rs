//! What a person gets wrong in a reference file is told at once, each mistake at its own place and with what would be right.

use shotdamp::reference::parse_reference;

use crate::desk::{GAP_REFERENCE, shotdamp, simulated};

/// The mistakes of entries: line, column, message and help.
fn told(text: &str) -> Vec<String> {
    let Err(problems) = parse_reference("ch3-x", "it.yaml", text) else { return Vec::new() };
    let one = |one: shotdamp::yaml::Problem| {
        let place = one.place.unwrap();
        let help = one.help.map_or_else(String::new, |help| format!(" | {help}"));
        format!("{}:{} {}{help}", place.line, place.column, one.message)
    };
    problems.list.into_iter().map(one).collect()
}

/// The mistakes of one entry with this check.
fn of(check: &str) -> Vec<String> {
    told(&format!("entries:\n- {{id: a, place: s. 1, says: It., {check}}}\n"))
}

fn meaning(check: &str) -> String {
    let text = format!("entries:\n- {{id: a, place: s. 1, says: It., {check}}}\n");
    let file = parse_reference("ch3-x", "it.yaml", &text).unwrap_or_else(|problems| panic!("{problems}"));
    serde_json::to_string(&file).unwrap()
}

#[test]
fn all_mistakes_of_a_reference_file_come_at_once_each_with_its_place() {
    let text = "entries:
  - id: first
    place: s. 1
    says: One.
    value: about 2
    form: {argmax: {of: velocity_ratio, over: force_ratio}}
  - id: second
    place: s. 1
    says: Two.
    where: {force: 1 kg, sweep: [a, b], force_ratio: {form: 1}}
    claim: {monotne: {of: velocity_ratio, over: force_ratio}}
  - id: second
    place: s. 1
    says: Three.
    claim: {monotone: {of: velocity_ratio, over: force_ratio, slack: 5 %}}
  - id: fourth
    place: s. 1
    claim: {equal: {values: [{number: 1}], within: 0.1}}
    expected: difers
  - id: fifth
    place: s. 1
    says: Five.
    value: \"5\"
    from: {ratio: {of: {cell: {of: velocity_ratio}}}}
    tolerance: {relative: -0.1, reason: none}
    blocked_by: [impulse]
not_judged:
  - {place: s. 1, says: Six., raeson: lost}
";
    let expected = "5:12 `about 2` is not a printed number: write digits as the study prints them, with a decimal point, and a unit: `427.3 mm/s`, `1.516`
6:5 an entry has no key `form` | did you mean `from`?
10:20 `1 kg` is not in N | write the number alone, in N, or with a unit of that kind
10:55 a range has no key `form` | did you mean `from`?
11:13 a claim has no form `monotne` | did you mean `monotone`?
12:9 an entry above has the id `second`
15:13 a rise or fall lacks `direction`: `increasing` or `decreasing`
15:70 `5 %` is not a number | write the fraction: 0.05
16:5 an entry lacks `says`
18:21 equality needs two numbers or more
18:52 a distance is relative to the larger number, or absolute | write {relative: 0.01} or {absolute: 0.01}
19:15 `difers` is not a verdict | did you mean `differs`?
24:12 a ratio lacks `to`
25:27 a number above zero is wanted
26:5 `blocked_by` belongs to claims | what a number waits for is read off its moved assumptions; an input without one needs an assumption with a `range`
28:31 a statement that is not judged has no key `raeson` | did you mean `reason`?";
    assert_eq!(told(text).join("\n"), expected);
}

#[test]
fn a_claim_or_a_way_to_take_a_number_that_is_none_is_told_with_those_that_are() {
    let claim = of("claim: {grows: {of: velocity_ratio}}");
    assert!(claim[0].contains("a claim has no form `grows` | known are `monotone`, `trend`"), "{claim:?}");
    let from = of("value: 2, from: {max: {of: velocity_ratio, over: force_ratio}}");
    assert!(from[0].contains("has no form `max` | known are `number`, `cell`"), "{from:?}");
    let none = of("expected: reproduced");
    assert_eq!(none, ["2:3 an entry lacks `value` or `claim` or `peak` or `curve` or `mode_shape`: how it is checked"]);
    let two = of("value: 2, from: {number: 2}, claim: {above: {of: velocity_ratio, level: 1}}");
    assert!(two[0].contains("an entry is checked in one way, not by both `value` and `claim`"), "{two:?}");
}

#[test]
fn a_number_may_have_the_unit_of_its_column_or_one_of_that_kind() {
    for (written, alone) in [
        ("value: 2, from: {cell: {of: velocity_ratio, where: {force: 1 N}}}", ("1 N", "1")),
        ("value: 2, from: {cell: {of: velocity_ratio, where: {force: [2 kN, 1]}}}", ("2 kN", "2000")),
        ("value: 2, from: {cell: {of: velocity_ratio, where: {gap: {from: 5 mm}}}}", ("5 mm", "0.005")),
        ("claim: {above: {of: rms_velocity, level: 3 mm/s}}", ("3 mm/s", "0.003")),
        ("value: 2, from: {mean_over: {of: x, over: angular_frequency, from: 26 rad/s}}", ("26 rad/s", "26")),
        ("claim: {best_place: {of: velocity_ratio, at: {gap: 2 cm}}}", ("2 cm", "0.02")),
        ("claim: {between: {value: {cell: {of: x}}, from: 3 mm}}, threshold_reason: none", ("3 mm", "0.003")),
        ("claim: {path_monotone: {of: x, direction: increasing, after: 5 ms}}", ("5 ms", "0.005")),
        (
            "claim: {between: {value: {cell: {of: floor_impact_lag}}, to: 18.6 ms}}, threshold_reason: none",
            ("18.6 ms", "0.0186"),
        ),
        (
            "claim: {equal: {values: [{number: 1}, {argmax: {of: x, over: gap}}], within: {absolute: 2 mm}}}, threshold_reason: none",
            ("2 mm", "0.002"),
        ),
    ] {
        let (unit, number) = alone;
        assert_eq!(meaning(written), meaning(&written.replace(unit, number)), "{written}");
    }
    // 2π is no word of a decimal number.
    let hertz = meaning("value: 2, from: {cell: {of: velocity_ratio, where: {angular_frequency: 1 Hz}}}");
    assert!(hertz.contains("6.283185307179586"), "{hertz}");
    for (written, says) in [
        ("where: {force: 1 mm}, claim: {above: {of: x, level: 1}}", "`1 mm` is not in N | write the number alone"),
        ("where: {force_ratio: 1 N}, claim: {above: {of: x, level: 1}}", "has a unit, but a dimensionless number"),
        ("where: {force: 1 parsec}, claim: {above: {of: x, level: 1}}", "`parsec` is not a unit that is known here"),
        ("where: {force: .nan}, claim: {above: {of: x, level: 1}}", "`.nan` is not a finite number"),
        ("claim: {between: {value: {cell: {of: x}}, from: 3 Hz}}, threshold_reason: none", "in rad/s or in one in Hz"),
        (
            "claim: {between: {value: {argmax: {of: velocity_ratio, over: force}}, to: 3 mm}}, threshold_reason: none",
            "`3 mm` is not in N",
        ),
        (
            "claim: {apart: {values: [{maximum: {of: velocity_ratio, over: gap}}, {number: 2}], by: {absolute: 3 mm}}}, threshold_reason: none",
            "has a unit, but a dimensionless number",
        ),
    ] {
        let said = of(written);
        assert!(said.len() == 1 && said[0].contains(says), "{written}: {said:?}");
    }
    // What a column of words holds is a word, whatever it looks like.
    assert!(meaning("where: {sweep: 3, force: 3}, claim: {above: {of: x, level: 1}}").contains(r#""text":"3""#));
}

#[test]
fn a_printed_number_of_another_kind_than_its_column_is_told_with_the_units_that_are_wanted() {
    for (written, says) in [
        (
            "value: 2 mm, from: {cell: {of: rms_velocity}}",
            "2:42 `2 mm` cannot be held against a column in `m/s` | print it in m/s, mm/s, or read another column",
        ),
        (
            "value: \"2\", from: {argmax: {of: velocity_ratio, over: angular_frequency}}",
            "2:42 `2` cannot be held against a column in `rad/s` | print it in Hz, rad/s, or read another column",
        ),
        (
            "value: 2 mm, from: {ratio: {of: {cell: {of: rms_velocity}}, to: {number: 2}}}",
            "2:42 `2 mm` cannot be held against a column without unit | print it without a unit, or read another column",
        ),
    ] {
        assert_eq!(of(written), [says], "{written}");
    }
    for fine in ["value: 2 mm/s, from: {cell: {of: rms_velocity}}", "value: 2 mm, from: {cell: {of: x}}"] {
        assert_eq!(of(fine), [""; 0], "{fine}");
    }
}

#[test]
fn a_tolerance_that_is_a_number_alone_is_answered_with_how_one_is_written() {
    for tolerance in ["5 %", "0.05", "±2 mm"] {
        let said = of(&format!("value: 2, from: {{number: 2}}, tolerance: {tolerance}"));
        assert!(
            said.len() == 1
                && said[0].contains("`relative` or `absolute`")
                && said[0].contains("{relative: 0.05, reason: "),
            "{said:?}"
        );
    }
}

#[test]
fn a_table_or_a_column_that_there_will_never_be_is_told_before_anything_runs() {
    let desk = simulated();
    let with = |entry: &str| {
        desk.put("reference/ch3/ch3-gap.yaml", &format!("{GAP_REFERENCE}{entry}"));
        shotdamp(&desk, &["check"])
    };
    let fine =
        "  - {id: more, place: s. 3, says: It., value: 2, from: {maximum: {of: velocity_ratio, over: gap_ratio}}}\n";
    assert!(!with(fine).err.contains("has no column"), "{}", with(fine).err);
    for (right, wrong, table) in [
        ("of: velocity_ratio", "of: velocity_ratoi", "ch3-gap"),
        ("over: gap_ratio", "over: gap_ratoi", "ch3-gap"),
        ("over: gap_ratio", "over: gap_ratio, where: {varient: baseline}", "ch3-gap"),
        ("over: gap_ratio", "over: gap_ratio, table: ch3-stop", "ch3-stop"),
    ] {
        let said = with(&fine.replace(right, wrong));
        assert_eq!(said.code, 2, "{wrong}: {}", said.err);
        let message = format!("error: the table of `{table}` has no column `");
        assert!(said.err.contains(&message) && said.err.contains("ch3-gap.yaml:"), "{wrong}: {}", said.err);
        assert!(table == "ch3-stop" || said.err.contains("did you mean `"), "{wrong}: {}", said.err);
    }
    let said = with(&fine.replace("over: gap_ratio", "over: gap_ratio, table: ch3-stpo"));
    assert_eq!(said.code, 2, "{}", said.err);
    for part in ["`ch3-stpo` is not an experiment of this study", "did you mean `ch3-stop`?"] {
        assert!(said.err.contains(part), "{}", said.err);
    }
}

#[test]
fn a_missing_key_is_told_with_the_words_that_it_takes() {
    let peak = of("value: 2, from: {peak: {of: velocity_ratio, over: force_ratio}}");
    assert_eq!(peak.len(), 2, "{peak:?}");
    assert!(peak[0].contains("a peak lacks `which`: `highest` or "), "{peak:?}");
    assert!(peak[1].contains("a peak lacks `read`: `place` or `height` or `half_power_width`"), "{peak:?}");
    let difference = of("value: 2, from: {difference: [a, b]}");
    assert!(difference[0].ends_with("not as a list | write {of: …, less: …}"), "{difference:?}");
}
