//! Where a structure does not move, a force drives nothing and there is nothing to observe.

use std::fs;

use shotdamp::experiment::{Assumptions, Experiment, parse_experiment, scaffold};
use shotdamp::study::forecast;
use shotdamp::yaml::Problems;

use crate::desk::{Desk, shotdamp};

const CANTILEVER: &str = "{cantilever_beam: {length: 1 m, width: 30 mm, thickness: 5 mm, youngs_modulus: 200 GPa, density: 7800 kg/m^3, rayleigh: 5e-5, modes: 4}}";
const PLATE: &str = "{supported_plate: {length: 1 m, width: 1 m, thickness: 5 mm, youngs_modulus: 200 GPa, poisson_ratio: 0.3, density: 7800 kg/m^3, rayleigh: 5e-5, modes: 4}}";

fn text(structure: &str, at: &str, rest: &str) -> String {
    format!(
        "title: t\nabout: a\nscene:\n  structure: {structure}\n  excitation: {{harmonic: {{at: {at}, force: 1 N, frequency_ratio: 1}}}}\n\
         {rest}\nrun: {{skip: 2 cycles, average: 5 cycles, ensemble: none}}\nmeasure: rms_velocity\n"
    )
}

fn parse(text: &str) -> Result<Experiment, Problems> {
    parse_experiment(&"x".parse().unwrap(), "mine.yaml", text, &Assumptions::default())
}

#[test]
fn a_force_on_a_support_is_refused() {
    for (structure, at, name) in [
        (CANTILEVER.to_owned(), "0", "a cantilever beam"),
        (CANTILEVER.replace("modes: 4", "modes: 40, basis: exact"), "0 m", "a cantilever beam"),
        (CANTILEVER.replace("cantilever_beam", "clamped_beam"), "1", "a beam clamped at both ends"),
        (PLATE.to_owned(), "[1, 0.5]", "a simply supported plate"),
        (PLATE.to_owned(), "[0.5, 0]", "a simply supported plate"),
    ] {
        let said = parse(&text(&structure, at, "")).expect_err(at).to_string();
        assert!(said.contains("the force stands where ") && said.contains("does not move"), "{name} {at}: {said}");
        assert!(said.contains("mine.yaml:5:"), "{said}");
        assert_eq!(said.matches("error").count(), 1, "{said}");
    }
    let observed = text(CANTILEVER, "1", "").replace("  excitation", "  observe: 0\n  excitation");
    let said = parse(&observed).expect_err("observed").to_string();
    assert!(said.contains("the observed point stands where a cantilever beam does not move"), "{said}");
}

/// Near a support the shapes have digits of their own.
#[test]
fn a_force_near_a_support_is_none_on_it() {
    for at in ["1e-5", "0.01 mm", "0.001", "1"] {
        let text = text(CANTILEVER, at, "");
        assert!(parse(&text).is_ok(), "{}", parse(&text).unwrap_err());
    }
    for at in ["[1e-9, 0.5]", "[0.5, 0.999]"] {
        assert!(parse(&text(PLATE, at, "")).is_ok(), "{at}");
    }
}

#[test]
fn a_damper_on_a_support_is_said_to_do_nothing() {
    for (structure, at, on_it) in
        [(CANTILEVER, "0", true), (CANTILEVER, "1e-5", false), (PLATE, "[0.5, 1]", true), (PLATE, "[0.5, 0.5]", false)]
    {
        let force = if structure == PLATE { "[0.5, 0.5]" } else { "1" };
        let damper = format!(
            "  dampers: [{{at: {at}, mass_ratio: 0.05, particle_share: 0.5, gap: 1 mm, floor: {{rigid: {{restitution: 0.5}}}}}}]"
        );
        let experiment = parse(&text(structure, force, &damper)).unwrap_or_else(|problems| panic!("{problems}"));
        let said = forecast(&experiment, &Assumptions::default()).join("\n");
        let warning = "damper 1 stands where the structure does not move: it does nothing";
        assert_eq!(said.contains(warning), on_it, "{structure} {at}: {said}");
    }
}

#[test]
fn a_sweep_may_pass_over_a_support_and_that_row_says_why_it_has_no_number() {
    let desk = Desk::new();
    desk.put("experiments/mine.yaml", &text(CANTILEVER, "swept", "sweep: {force_x: [0, 0.5, 1]}"));
    let said = shotdamp(&desk, &["run", "mine"]);
    let all = said.out + &said.err;
    assert!(all.contains("the force stands where a cantilever beam does not move"), "{all}");
    let table = desk.table("mine");
    let velocity = table.floats("rms_velocity").unwrap();
    assert_eq!(velocity.iter().map(|value| value.is_finite()).collect::<Vec<_>>(), [false, true, true]);
    let alone = parse(&text(CANTILEVER, "swept", "sweep: {force_x: [0]}")).expect_err("no row is left").to_string();
    assert!(alone.contains("does not move"), "{alone}");
}

#[test]
fn a_new_experiment_on_a_beam_has_damper_and_force_where_it_moves() {
    let id = "my-beam".parse().unwrap();
    for structure in ["clamped_beam", "cantilever_beam"] {
        let text = scaffold(&id, structure, "schema.json").unwrap();
        assert_eq!(text.matches("at: 0.5").count(), 2, "{text}");
        let read = parse_experiment(&id, "mine.yaml", &text, &Assumptions::default());
        assert!(read.is_ok(), "{}", read.unwrap_err());
    }
    let desk = Desk::new();
    assert_eq!(shotdamp(&desk, &["new", "my-beam", "--structure", "clamped_beam"]).code, 0);
    assert!(fs::read_to_string(desk.layout.path("experiments/my-beam.yaml")).unwrap().contains("at: 0.5"));
}
