//! The page of hard cases: what each checks, what its tests came to, and how far they might have gone.
//!
//! `SHOTDAMP_WRITE_HARD_CASES=1 cargo test --test it hard_cases` runs them all once more, listens to their comparisons and
//! writes `reports/hard-cases.md`.

use std::fmt::Write as _;
use std::path::Path;

use super::bench::{Ledger, listened};
use super::{
    arrays, averages, closed_forms, critical_damping, equal_modes, event_cases, extremes, floating, half_cycles,
    long_runs, precise, properties, reference_cases, resonance, walls,
};
use crate::{spec, structures};

struct HardCase {
    name: &'static str,
    checks: &'static str,
    reference: &'static str,
    tests: &'static [fn()],
}

const HARD_CASES: &[HardCase] = &[
    HardCase {
        name: "Chatter: infinitely many impacts in finite time, ε from 0.5 to 0.999, base at rest or accelerated",
        checks: "instant of the last impact, common motion after it",
        reference: "geometric series",
        tests: &[
            closed_forms::chatter_ends_where_the_geometric_series_does,
            closed_forms::an_accelerated_base_is_a_stronger_gravity,
            closed_forms::the_ball_of_the_sensitivity_suites_is_met_to_all_printed_digits,
        ],
    },
    HardCase {
        name: "Ball on a sinusoidal table: periodic, at period doubling, sticking",
        checks: "phase and speed of impacts, phase of separation",
        reference: "closed forms",
        tests: &[
            closed_forms::a_ball_on_a_vibrating_table_keeps_its_phase,
            closed_forms::just_below_period_doubling_every_flight_is_alike,
            closed_forms::an_inelastic_ball_leaves_and_lands_at_the_phases_of_theory,
            closed_forms::a_particle_rests_until_the_base_falls_faster_than_it,
        ],
    },
    HardCase {
        name: "Contact that grazes, 1e-12 m²/s² to either side",
        checks: "number, order and times of events",
        reference: "parabola of flight",
        tests: &[closed_forms::a_particle_that_grazes_the_ceiling_is_met_on_both_sides],
    },
    HardCase {
        name: "Grazing ceilings, creeping releases, gaps of 50 nm, floors a million times stiffer, impulses a nanosecond from \
               an impact",
        checks: "every event of 25 scenes, in order and in time",
        reference: "128-bit arithmetic",
        tests: &[event_cases::no_event_is_lost_or_doubled],
    },
    HardCase {
        name: "Events at one instant: by symmetry, of two dampers on one mass, of a seesaw",
        checks: "symmetric scenes stay symmetric, no damper comes before another",
        reference: "symmetry; one particle of both masses; momentum",
        tests: &[
            arrays::what_is_symmetric_stays_so,
            arrays::two_particles_that_land_at_once_land_as_one_of_both_masses,
            arrays::a_blow_from_above_leaves_the_neighbour_that_loses_its_floor,
            arrays::no_damper_comes_before_another,
        ],
    },
    HardCase {
        name: "No dissipation for 100 000 cycles, rigid and resilient faces",
        checks: "energy",
        reference: "its value at the start",
        tests: &[
            long_runs::what_nothing_takes_stays_for_a_hundred_thousand_cycles,
            long_runs::what_nothing_takes_does_not_drift,
        ],
    },
    HardCase {
        name: "No dissipation, several dampers: back to the start when time is turned round",
        checks: "state",
        reference: "itself",
        tests: &[arrays::an_array_without_loss_runs_back_to_its_start],
    },
    HardCase {
        name: "Floor damping swept through critical, to 1e-15 of it: defective matrices",
        checks: "end of the run, smoothness in cf",
        reference: "arithmetic of 32 digits; both sides of the sweep",
        tests: &[extremes::a_floor_swept_through_critical_damping_has_no_seam],
    },
    HardCase {
        name: "Modes that coalesce, and within 1e-12 of it: no eigenbasis",
        checks: "end of the run, smoothness in cf",
        reference: "arithmetic of 32 digits; both sides of the sweep",
        tests: &[extremes::modes_that_coalesce_are_no_special_case],
    },
    HardCase {
        name: "Critical damping of a mode beside others, and 1e-15 to 1e-5 from it; twins that press faces of critical damping",
        checks: "averages of squares; energy",
        reference: "closed form; conservation",
        tests: &[
            critical_damping::averages_of_a_mode_at_critical_damping_are_those_of_the_formula,
            critical_damping::energy_is_balanced_where_twins_press_faces_of_critical_damping,
        ],
    },
    HardCase {
        name: "Equal frequencies",
        checks: "motion in turned axes, dampers that are alike",
        reference: "modes that swing alone",
        tests: &[
            equal_modes::modes_of_equal_frequency_swing_as_if_they_were_alone,
            equal_modes::dampers_that_are_alike_on_masses_that_are_alike_do_not_disturb_each_other,
        ],
    },
    HardCase {
        name: "Structure that nothing brings back: double zero eigenvalue",
        checks: "parabola, terminal velocity, sinking",
        reference: "closed forms",
        tests: &[
            floating::a_base_on_a_dashpot_stops_where_its_impulse_is_used_up,
            floating::under_a_constant_force_it_creeps_at_its_terminal_velocity,
            floating::a_particle_on_it_makes_it_sink,
            floating::bounces_on_a_sliding_base_lose_nothing_but_to_its_dashpot,
        ],
    },
    HardCase {
        name: "Floor stiffness from 1e-3 to 1e6 of the structure's",
        checks: "end of the run; events do not grow with stiffness",
        reference: "arithmetic of 32 digits",
        tests: &[extremes::a_floor_is_no_dearer_for_being_stiffer],
    },
    HardCase {
        name: "Floor stiffness to 1e9 N/m: to the rigid floor",
        checks: "restitution, and how fast it is reached",
        reference: "restitution of half a cycle",
        tests: &[closed_forms::a_stiff_floor_tends_to_the_restitution_of_half_a_cycle],
    },
    HardCase {
        name: "Wall stiffness to 1e9 N/m: Model 3 to Model 2",
        checks: "RMS velocity, and how fast it is reached",
        reference: "Model 2",
        tests: &[extremes::stiff_walls_make_model_3_model_2],
    },
    HardCase {
        name: "mp/m from 1e-9 to 1e3, h from 0 to ∞, f′ from 1e-6 to 1e6",
        checks: "end of the run; the clean structure at mp/m = 1e-9",
        reference: "arithmetic of 32 digits; closed form",
        tests: &[extremes::nothing_is_too_light_too_heavy_too_wide_or_too_strong],
    },
    HardCase {
        name: "Forcing period to 0",
        checks: "place of the particle, and how fast the limit is reached",
        reference: "constant force",
        tests: &[extremes::impulses_without_pause_are_a_constant_force],
    },
    HardCase {
        name: "Forcing period to 1e5 s, everything decays to nothing",
        checks: "energy spent between impulses, rest",
        reference: "J²/2m; the first decay",
        tests: &[extremes::long_pauses_leave_one_free_decay_each],
    },
    HardCase {
        name: "Heavy damping that ties all modes together",
        checks: "end of the run, ten random structures with two dampers",
        reference: "arithmetic of 32 digits",
        tests: &[extremes::dashpots_that_tie_all_modes_together_are_no_harder],
    },
    HardCase {
        name: "Polynomial basis up to 60 terms",
        checks: "frequencies converge from above",
        reference: "exact beam",
        tests: &[structures::the_studys_polynomials_give_its_frequencies_and_converge_from_above_however_many],
    },
    HardCase {
        name: "Cantilever mode shapes up to n = 60",
        checks: "frequencies, tip value, orthogonality",
        reference: "roots of the characteristic equation; 2 (−1)ⁿ⁺¹; quadrature",
        tests: &[structures::a_cantilever_has_the_exact_frequencies_and_stays_right_to_sixty_modes],
    },
    HardCase {
        name: "Limit stop, plastic and not",
        checks: "times and speeds",
        reference: "closed forms",
        tests: &[closed_forms::a_limit_stop_takes_what_its_restitution_leaves],
    },
    HardCase {
        name: "Free base, 1000 elastic bounces: two large places, a small gap",
        checks: "lift-off and its speed",
        reference: "closed form",
        tests: &[closed_forms::elastic_bounces_keep_their_period],
    },
    HardCase {
        name: "Contact damping below, at and above critical; floors that can pull and that cannot",
        checks: "restitution, contact time",
        reference: "closed forms",
        tests: &[
            closed_forms::a_spring_with_a_dashpot_has_its_restitution,
            closed_forms::a_floor_that_cannot_pull_has_its_own_restitution,
        ],
    },
    HardCase {
        name: "Any run, a chaotic one too",
        checks: "momentum and energy balances; no particle beyond a rigid face; mean displacement",
        reference: "conservation laws",
        tests: &[
            arrays::momentum_and_energy_close_and_no_particle_is_beyond_its_face,
            closed_forms::the_mean_displacement_is_what_momentum_asks_for,
        ],
    },
    HardCase {
        name: "Point impulse on a beam of n modes",
        checks: "velocities; kinetic energy just after it",
        reference: "sum of the modes",
        tests: &[
            structures::impulses_on_the_clean_cantilever_are_the_sum_of_their_modes,
            structures::kinetic_energies_are_kept_cycle_by_cycle,
        ],
    },
    HardCase {
        name: "A million forcing cycles",
        checks: "where in its cycle an event falls",
        reference: "the thousandth cycle",
        tests: &[long_runs::after_a_million_cycles_an_impulse_falls_where_the_thousandth_fell],
    },
    HardCase {
        name: "Particles that a ceiling lets go together",
        checks: "no contact made of rounding, the same events by shorter windows",
        reference: "itself",
        tests: &[arrays::particles_that_a_ceiling_lets_go_together_leave_together],
    },
    HardCase {
        name: "Equivalent viscous damping: base without damping, motion that dies away, arrays of light dampers",
        checks: "momentum and energy; damping of no motion",
        reference: "conservation; the curve's lower end",
        tests: &[
            half_cycles::a_base_without_damping_counts_its_half_cycles,
            half_cycles::half_cycles_end_where_motion_has_died_away,
            half_cycles::arrays_of_equal_light_dampers_have_contact_states_of_any_order,
            half_cycles::no_array_is_refused_and_all_balance_whatever_their_order,
        ],
    },
    HardCase {
        name: "Impulses so close that the displacement is all mean; pulses from rest",
        checks: "RMS velocity, mean and deviation; momentum and energy",
        reference: "sawtooth and parabola; conservation",
        tests: &[
            averages::impulses_without_pause_leave_a_sawtooth_and_a_parabola,
            averages::the_audit_of_a_pulse_from_rest_closes_whatever_the_damping,
        ],
    },
    HardCase {
        name: "Chaotic range",
        checks: "mean of an ensemble within 3.5 standard errors",
        reference: "another ensemble",
        tests: &[long_runs::a_chaotic_mean_is_known_to_its_standard_error],
    },
    HardCase {
        name: "Particle pressed by floor and ceiling at once",
        checks: "state at the end; momentum and energy",
        reference: "closed form of the oscillator; Runge-Kutta; limit of no gap; conservation",
        tests: &[
            walls::a_mass_between_two_springs_and_dashpots_is_an_oscillator_of_both,
            walls::springs_of_faces_that_meet_a_particle_at_once_push_as_a_runge_kutta_integration_says,
            walls::a_gap_that_vanishes_is_no_gap,
            walls::between_walls_of_any_kind_momentum_and_energy_close_unless_both_faces_are_rigid,
        ],
    },
    HardCase {
        name: "Structure without damping, driven at its own frequency, and 1e-15 to 5e-3 apart from it",
        checks: "place and velocity after up to 1000 cycles; momentum and energy",
        reference: "closed form; 32-digit arithmetic; conservation",
        tests: &[
            resonance::at_resonance_and_next_to_it_the_motion_grows_as_its_closed_form,
            resonance::each_mode_of_a_structure_has_its_resonance,
            resonance::no_structure_is_refused_at_its_own_frequency,
        ],
    },
    HardCase {
        name: "Particle held by two rigid faces that move by themselves",
        checks: "refused by name",
        reference: "—",
        tests: &[walls::rigid_faces_that_would_both_hold_a_particle_are_refused_by_name],
    },
    HardCase {
        name: "NaN, negative mass, gap below zero, unknown key, wrong unit, huge and empty sweeps",
        checks: "refused with place and reason before anything runs",
        reference: "—",
        tests: &[
            spec::mistakes_that_a_person_makes_are_told_where_they_stand,
            spec::a_unit_of_the_wrong_kind_is_told_in_words,
            spec::yaml_from_strangers_is_refused_before_anything_grows,
        ],
    },
    HardCase {
        name: "Single dampers, 125 cycles, 29 scenes of Models 1, 2 and 3",
        checks: "averages, first events, end of the run",
        reference: "128-bit arithmetic",
        tests: &[reference_cases::every_reference_case_is_met_to_rounding],
    },
    HardCase {
        name: "28 of them by the solver of 32 digits, the reference of others; it has no rigid faces that bounce",
        checks: "averages, first events, end of the run",
        reference: "128-bit arithmetic",
        tests: &[precise::it_meets_the_reference_cases_to_all_digits_of_a_double],
    },
    HardCase {
        name: "Random scenes: springs of faces",
        checks: "end of the run",
        reference: "Runge-Kutta integration; arithmetic of 32 digits",
        tests: &[
            arrays::springs_of_floors_and_ceilings_push_as_a_runge_kutta_integration_says,
            properties::random_scenes_end_where_many_digits_say,
        ],
    },
    HardCase {
        name: "Random scenes: left alone",
        checks: "energy never grows",
        reference: "itself",
        tests: &[properties::left_alone_no_scene_gains_energy],
    },
    HardCase {
        name: "Random scenes: described in another order",
        checks: "in other units, in one cycle or in 64, in search windows half as long",
        reference: "itself",
        tests: &[
            properties::units_are_a_matter_of_taste,
            arrays::a_run_is_the_same_in_one_cycle_or_in_many,
            properties::shorter_search_windows_find_the_same_events,
        ],
    },
];

#[test]
fn the_page_is_written_when_asked_for() {
    if std::env::var_os("SHOTDAMP_WRITE_HARD_CASES").is_none() {
        return;
    }
    let reports = Path::new(env!("CARGO_MANIFEST_DIR")).join("reports");
    let peers = "accuracy/peers-events.md";
    let beside = if reports.join(peers).exists() {
        format!(" · [other solvers on the same sequences of events]({peers})")
    } else {
        String::new()
    };
    let mut page = format!(
        "# Hard cases\n\n[All experiments](README.md){beside}\n\nScenes that break codes, each with a reference that is not the code \
         under test. Written by `SHOTDAMP_WRITE_HARD_CASES=1 cargo test --test it hard_cases`, from the comparisons of the \
         tests themselves: Error is that of the comparison that came closest to its bound. Where runs are sensitive \
         the bound includes what a drive known to twelve digits would change.\n\n\
         | Case | Checks | Reference | Comparisons | Closest to its bound | Error | Bound |\n| --- | --- | --- | ---: | --- | ---: | ---: |\n",
    );
    for HardCase { name, checks, reference, tests } in HARD_CASES {
        let Ledger { comparisons, worst: [figure, bound], what } = listened(tests);
        let [count, figure, bound] = if comparisons == 0 {
            ["".into(), "holds".into(), "".into()]
        } else {
            [comparisons.to_string(), format!("{figure:.1e}"), format!("{bound:.1e}")]
        };
        let _ = writeln!(page, "| {name} | {checks} | {reference} | {count} | {what} | {figure} | {bound} |");
    }
    std::fs::write(reports.join("hard-cases.md"), page).expect("the folder of reports can be written");
}
