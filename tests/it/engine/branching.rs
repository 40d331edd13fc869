//! Branches that begin at special points of others, against maps that the tests iterate by themselves and against closed forms.

use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix2, Vector2};
use shotdamp::dynamics::{
    Along, Branch, BranchEnd, BranchPoint, Contact, Drive, EventKind, Face, HybridSystem, Law, Matrix, Options, Orbit,
    Particle, Placed, Special, StartState, Tick,
};
use shotdamp::scene::Excitation;

use super::bench::{base, close, damper, in_flight, rigid, scene, system, within};
use super::closed_forms::masri_and_caughey;
use super::motion::Table;
use super::orbits::Masri;

/// The points of a branch of one kind.
fn special(branch: &Branch<Infallible>, kind: Special) -> Vec<&BranchPoint> {
    branch.points.iter().filter(|point| point.special == Some(kind)).collect()
}

/// The last number of an interval, to its last bit, for which something holds that holds at its begin and not at its end.
fn last(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    while low < 0.5 * (low + high) && 0.5 * (low + high) < high {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

/// A ball on a table x = Γ sin φ in units of g and ω: phase and velocity after an impact to those after the next.
struct Ball {
    restitution: f64,
    acceleration: f64,
}

impl Ball {
    /// The next impact, the flight to it by steps and halvings; and the derivative of the map.
    fn bounce(&self, [phase, velocity]: [f64; 2]) -> ([f64; 2], Matrix2<f64>) {
        let (e, table) = (self.restitution, self.acceleration);
        let above = |t: f64| table * (phase.sin() - (phase + t).sin()) + velocity * t - 0.5 * t * t;
        let mut high = 1e-3;
        while above(high) > 0.0 {
            high += 1e-3;
        }
        let low = last(high - 1e-3, high, |t| above(t) > 0.0);
        let next = phase + low;
        let (leaves, meets) = (table * phase.cos(), table * next.cos());
        let falls = velocity - low;
        // dt of the flight by phase and velocity, then d(φ⁺) and d(v⁺), v⁺ = (1 + ε) x′ − ε (v − t).
        let flight = [(leaves - meets) / (meets - falls), low / (meets - falls)];
        let bend = -(1.0 + e) * table * next.sin();
        let derivative = Matrix2::new(
            1.0 + flight[0],
            flight[1],
            bend * (1.0 + flight[0]) + e * flight[0],
            bend * flight[1] - e * (1.0 - flight[1]),
        );
        ([next, (1.0 + e) * meets - e * falls], derivative)
    }

    /// The motion of so many impacts, one a cycle, next to a state; and 1 + trace + determinant of its map, zero where it doubles.
    fn cycle(&self, impacts: usize, mut state: [f64; 2]) -> ([f64; 2], f64) {
        for _ in 0..20 {
            let (mut end, mut map) = (state, Matrix2::identity());
            for _ in 0..impacts {
                let (next, derivative) = self.bounce(end);
                (end, map) = (next, derivative * map);
            }
            let turns = TAU * impacts as f64;
            let miss = Vector2::new(end[0] - turns - state[0], end[1] - state[1]);
            if miss.norm() < 1e-13 {
                return (state, 1.0 + map.trace() + map.determinant());
            }
            let step = (Matrix2::identity() - map).try_inverse().expect("it is isolated") * miss;
            state = [state[0] + step[0], state[1] + step[1]];
        }
        panic!("no cycle of {impacts} impacts at Γ = {}", self.acceleration)
    }

    /// Γ above `from`, where the motion of so many impacts attracts, at which its period doubles.
    fn doubling(restitution: f64, impacts: usize, from: f64) -> f64 {
        let at = |acceleration: f64| Self { restitution, acceleration };
        let settled = (0..4000).fold([1.0, 3.0], |state, _| at(from).bounce(state).0);
        let (mut state, value) = at(from).cycle(impacts, [settled[0].rem_euclid(TAU), settled[1]]);
        assert!(value > 0.0, "it attracts");
        let (mut low, mut high) = (from, from);
        while high == low {
            let next = at(low + 1e-4).cycle(impacts, state);
            if next.1 > 0.0 {
                (low, high, state) = (low + 1e-4, low + 1e-4, next.0);
            } else {
                high = low + 1e-4;
            }
        }
        last(low, high, |acceleration| at(acceleration).cycle(impacts, state).1 > 0.0)
    }
}

#[test]
fn a_cascade_doubles_again_where_the_iterated_map_does() {
    let e = 0.5;
    let systems = |acceleration: f64| Ok::<HybridSystem, Infallible>(system(&Table::new(e, acceleration).scene()));
    let along = Along { from: 1.4, to: 1.72, step: 0.02, points: 500 };
    let first = Orbit::near(&systems(1.4).expect("it compiles"), &Table::new(e, 1.4).on_orbit(0.0), 1);
    let mut branch = Branch::follow(systems, &first.expect("it is near"), 1.4, along).expect("it has a first orbit");
    for (cycles, attracts_at) in [(1, 1.45), (2, 1.6), (4, 1.68)] {
        let [doubles] = special(&branch, Special::PeriodDoubling)[..] else { panic!("{cycles} cycles double once") };
        let expected = Ball::doubling(e, cycles as usize, attracts_at);
        close(&format!("doubling of {cycles} cycles"), doubles.parameter, expected, 1e-10);
        assert_eq!((doubles.orbit.cycles, &branch.end), (cycles, &BranchEnd::Range));
        let doubled = Branch::doubled(systems, doubles, along).expect("it begins there");
        if cycles == 1 {
            // Followed back, a doubled motion comes to the one that it began at.
            let away = &doubled.points[doubled.points.len() / 2];
            let down = Along { from: along.to, to: along.from, ..along };
            let back = Branch::follow(systems, &away.orbit, away.parameter, down).expect("it has a first orbit");
            let last = back.points.last().expect("it has points").parameter;
            assert_eq!(back.end, BranchEnd::HalfPeriod);
            within("its end", last, expected, along.step * (along.to - along.from));
        }
        branch = doubled;
    }
    assert!(branch.points[1..].iter().all(|point| point.orbit.cycles == 8));
}

#[test]
fn doubled_motions_end_where_they_meet_the_shorter_one_and_branches_from_both_ends_agree() {
    // One mass with a particle between unlike resilient faces, struck once a cycle: 4 cycles double to 8 and come back to 4 twice.
    let face = |stiffness, damping| Face {
        row: vec![1.0],
        law: Law::Resilient { stiffness, damping, no_tension: false, stop: None },
    };
    let stiffness = 450.5_f64;
    let systems = |impulse: f64| {
        Ok::<HybridSystem, Infallible>(HybridSystem {
            mass: Matrix::diagonal(&[1.0]),
            damping: Matrix::diagonal(&[0.2 * stiffness.sqrt()]),
            stiffness: Matrix::diagonal(&[stiffness]),
            gravity: 0.0,
            particles: vec![Particle {
                mass: 0.03217,
                floor: face(1862.0, 4.987),
                ceiling: Some(face(7784.0, 1.05)),
                gap: 0.01806,
            }],
            force_row: vec![1.0],
            drive: Drive {
                period: 0.20095,
                ticks: vec![Tick { time: 0.0, impulse, level: 0.0 }],
                repeats: true,
                harmonic: None,
                half_cycles: None,
            },
            observed_rows: vec![vec![1.0]],
            momentum_rows: vec![vec![1.0]],
        })
    };
    let along = Along { from: 0.5, to: 0.9, step: 0.02, points: 200 };
    let system = systems(0.71).expect("it compiles");
    let start =
        StartState::Given { q: vec![0.01], rate: vec![0.1], particles: vec![Placed::new(Contact::Flight, 0.01, -0.2)] };
    let settled = Options { skip: 200, average: 50, start, ..Options::default() };
    let orbit = Orbit::after(&system, &settled).expect("it settles");
    assert_eq!(orbit.cycles, 4);
    let upwards = Branch::follow(systems, &orbit, 0.71, along).expect("it has a first orbit");
    let doublings = special(&upwards, Special::PeriodDoubling);
    let branches: Vec<_> = doublings
        .iter()
        .map(|doubling| (doubling.parameter, Branch::doubled(systems, doubling, along).expect("it begins there")))
        .collect();
    assert_eq!(branches.len(), 3);
    for (_, branch) in &branches {
        assert_eq!(branch.end, BranchEnd::HalfPeriod);
        for point in &branch.points[1..] {
            let system = systems(point.parameter).expect("it compiles");
            let again = Orbit::near(&system, &point.orbit.start, 8).expect("it closes");
            assert_eq!(again.cycles, 8, "at {} N s", point.parameter);
        }
    }
    // Two of them are one branch, followed from either end.
    let ends = |branch: &Branch<Infallible>| branch.points.last().expect("it has points").parameter;
    let [_, (low, up), (high, down)] = &branches[..] else { panic!("three doublings") };
    within("the end above", ends(up), *high, 1e-3);
    within("the end below", ends(down), *low, 1e-3);
    let mut others = special(down, Special::PeriodDoubling);
    others.reverse();
    let ups = special(up, Special::PeriodDoubling);
    assert_eq!((ups.len(), others.len()), (2, 2));
    for (one, other) in ups.iter().zip(others) {
        close("a doubling of 8 cycles", one.parameter, other.parameter, 1e-9);
    }
}

/// A particle without mass between two walls A sin φ and h + A sin φ (impact pair). The motion with an impact on each wall a cycle, half a
/// cycle apart, has π A cos φ = r (h − 2 A sin φ) at the floor, r = (1 − ε)/(1 + ε), and the speed V = (h − 2 A sin φ) ω/π (Heiman,
/// Sherman & Bajaj 1987). Its map of half a cycle, upside down, of the phase and of the speed,
///
/// N = [ε, −(1 + ε) π/(2 ω V); (1 + ε) ε X″, ε − (1 + ε)² X″ π/(2 ω V)],   X″ = −A ω² sin φ,
///
/// has the eigenvalue 1 where tan φ = 2 r/π, at A = h r/√(π² + 4 r²), and −1 where tan φ = −2/(π r), at A = h √(π² r² + 4)/(π² − 4).
struct Pair {
    restitution: f64,
    gap: f64,
}

impl Pair {
    const STIFFNESS: f64 = 1000.0;
    const OMEGA: f64 = 60.0;

    fn ratio(&self) -> f64 {
        (1.0 - self.restitution) / (1.0 + self.restitution)
    }

    fn fold(&self) -> f64 {
        self.gap * self.ratio() / PI.hypot(2.0 * self.ratio())
    }

    fn symmetry_breaking(&self) -> f64 {
        self.gap * (PI * self.ratio()).hypot(2.0) / (PI * PI - 4.0)
    }

    /// Damping of the mass that moves the walls, and the lag of its motion behind the force.
    fn lag() -> f64 {
        (Self::STIFFNESS.sqrt() * Self::OMEGA).atan2(Self::STIFFNESS - Self::OMEGA * Self::OMEGA)
    }

    fn system(&self, amplitude: f64) -> HybridSystem {
        let damping = Self::STIFFNESS.sqrt();
        let force = amplitude * (Self::STIFFNESS - Self::OMEGA.powi(2)).hypot(damping * Self::OMEGA);
        let drive = Excitation::Harmonic { force, angular_frequency: Self::OMEGA };
        let mass = base(1.0, Self::STIFFNESS, damping);
        system(&scene(mass, 0.0, damper(0.0, self.gap, rigid(self.restitution)), drive))
    }

    /// The symmetric motion at the start of a cycle, of the greater speed.
    fn start(&self, amplitude: f64) -> StartState {
        let (r, omega) = (self.ratio(), Self::OMEGA);
        // A (π cos φ + 2 r sin φ) = h r.
        let phase = (2.0 * r).atan2(PI) - (self.gap * r / (amplitude * PI.hypot(2.0 * r))).acos();
        let place = amplitude * phase.sin();
        let speed = (self.gap - 2.0 * place) * omega / PI;
        let since = (-Self::lag() - phase).rem_euclid(TAU);
        let [y, w] = if since < PI {
            [place + speed * since / omega, speed]
        } else {
            [self.gap - place - speed * (since - PI) / omega, -speed]
        };
        let [x, v] = [amplitude * (-Self::lag()).sin(), amplitude * omega * (-Self::lag()).cos()];
        in_flight([x, v], [y - x, w - v])
    }

    /// By how much an orbit with one impact on either wall misses flights at constant speed and impacts with this restitution.
    fn misses(&self, amplitude: f64, orbit: &Orbit) -> f64 {
        let omega = Self::OMEGA;
        let contact = |kind: EventKind| {
            let event = orbit.response.events.iter().find(|event| event.kind == kind).expect("it meets both walls");
            let phase = omega * event.time - Self::lag();
            [phase, amplitude * phase.sin(), amplitude * omega * phase.cos(), event.approach]
        };
        let [down, floor, floor_speed, falls] = contact(EventKind::FloorContact);
        let [up, ceiling, ceiling_speed, rises] = contact(EventKind::CeilingContact);
        let way = self.gap + ceiling - floor;
        let (before, after) = (floor_speed + falls, floor_speed - self.restitution * falls);
        let (rise, fall) = (ceiling_speed + rises, ceiling_speed - self.restitution * rises);
        let flight = |from: f64, to: f64| (to - from).rem_euclid(TAU) / omega;
        let misses = [
            (after - rise) / after,
            (fall - before) / before,
            rise * flight(down, up) / way - 1.0,
            before * flight(up, down) / way + 1.0,
        ];
        misses.into_iter().fold(0.0, |most: f64, miss| most.max(miss.abs()))
    }
}

#[test]
fn the_impact_pair_loses_its_symmetry_where_half_a_cycle_has_the_eigenvalue_minus_one() {
    for restitution in [0.3, 0.5, 0.8] {
        let pair = Pair { restitution, gap: 0.01 };
        let expected = pair.symmetry_breaking();
        let systems = |amplitude: f64| Ok::<HybridSystem, Infallible>(pair.system(amplitude));
        let begin = 0.5 * (expected + pair.fold());
        let along = Along { from: begin, to: 1.15 * expected, step: 0.02, points: 500 };
        let orbit = Orbit::near(&pair.system(begin), &pair.start(begin), 1).expect("it is near");
        assert_eq!((orbit.cycles, orbit.contacts), (1, 2));
        let branch = Branch::follow(systems, &orbit, begin, along).expect("it has a first orbit");
        let [fork] = special(&branch, Special::SymmetryBreaking)[..] else { panic!("one loss of symmetry") };
        close(&format!("ε = {restitution}, symmetry breaking"), fork.parameter, expected, 1e-11);
        within("multiplier", fork.orbit.multipliers[0].modulus, 1.0, 1e-8);
        within("orbit there", pair.misses(fork.parameter, &fork.orbit), 0.0, 1e-10);
        for point in branch.points.iter().filter(|point| point.special.is_none()) {
            assert_eq!(point.orbit.is_stable(), point.parameter < fork.parameter);
        }
        // Where it turns, nothing but a fold is found.
        let down = Along { from: begin, to: 0.9 * pair.fold(), ..along };
        let turned = Branch::follow(systems, &orbit, begin, down).expect("it has a first orbit");
        let kinds: Vec<Special> = turned.points.iter().filter_map(|point| point.special).collect();
        close("fold", special(&turned, Special::Fold)[0].parameter, pair.fold(), 1e-10);
        assert!(!kinds.contains(&Special::SymmetryBreaking));

        let both = Branch::asymmetric(systems, fork, along).expect("they begin there");
        for branch in &both {
            let points = &branch.points[1..];
            assert!(points.len() > 5 && points[0].orbit.is_stable());
            for point in points {
                assert_eq!((point.orbit.cycles, point.orbit.contacts), (1, 2));
                within("flights and impacts", pair.misses(point.parameter, &point.orbit), 0.0, 1e-10);
            }
        }
        // One is the other upside down, half a cycle later; neither is its own mirror image.
        let phase = |branch: &Branch<Infallible>, kind: EventKind| {
            let last = branch.points.last().expect("it has points");
            let contact = last.orbit.response.events.iter().find(|event| event.kind == kind).expect("it meets it");
            Pair::OMEGA * contact.time
        };
        let off = |one: f64, other: f64| (one - other).rem_euclid(TAU) - PI;
        let [one, other] = &both;
        assert_eq!((&one.end, &other.end), (&BranchEnd::Range, &BranchEnd::Range));
        let up = phase(one, EventKind::CeilingContact);
        within("mirror image", off(up, phase(other, EventKind::FloorContact)), 0.0, 1e-9);
        assert!(off(up, phase(one, EventKind::FloorContact)).abs() > 0.01);
        // Followed back, they end where they began.
        let back = Along { from: along.to, to: along.from, ..along };
        for branch in &both {
            let away = &branch.points[branch.points.len() / 2];
            let back = Branch::follow(systems, &away.orbit, away.parameter, back).expect("it has a first orbit");
            let last = back.points.last().expect("it has points").parameter;
            assert_eq!(back.end, BranchEnd::Symmetry);
            within("its end", last, expected, along.step * (along.to - along.from));
        }
    }
}

#[test]
fn the_impact_damper_loses_its_symmetry_at_the_speed_of_the_closed_form() {
    let masri = Masri { ratio: 1.1, gap: 0.1, restitution: 0.6, particle: 0.1 };
    let speed = masri.symmetry_breaking();
    let closest = masri.multipliers(speed).into_iter().map(|[modulus, _]| (modulus - 1.0).abs());
    within("multiplier of the closed form", closest.fold(f64::INFINITY, f64::min), 0.0, 1e-12);

    let systems = |force: f64| Ok::<HybridSystem, Infallible>(masri.system(force));
    let steady = masri_and_caughey("masri-caughey-two-impacts-b", 0.246_499_927_843_622_73);
    let [y, w] = steady.response.final_particles[0];
    let (x, v) = (steady.response.final_displacement, steady.response.final_velocity);
    let orbit = Orbit::near(&masri.system(10.0), &in_flight([x, v], [y - x, w - v]), 1).expect("it is near");
    let along = Along { from: 10.0, to: 20.0, step: 0.02, points: 500 };
    let branch = Branch::follow(systems, &orbit, 10.0, along).expect("it has a first orbit");
    let [fork] = special(&branch, Special::SymmetryBreaking)[..] else { panic!("one loss of symmetry") };
    close("symmetry breaking", fork.parameter, masri.force(speed), 1e-10);
    let both = Branch::asymmetric(systems, fork, along).expect("they begin there");
    for branch in &both {
        assert!(branch.points[1].orbit.is_stable() && branch.points.len() > 5);
    }
}

#[test]
fn special_points_do_not_depend_on_the_length_of_steps() {
    for (ratio, particle, [from, to]) in [(1.03, 0.1, [3.0, 0.1]), (1.1, 0.1, [1.5, 0.1]), (0.97, 0.05, [2.0, 0.1])] {
        let masri = Masri { restitution: 0.5, particle, ..Masri::at(ratio) };
        let least = masri.least_force();
        let force = from * least;
        let orbit = Orbit::near(&masri.system(force), &masri.start(masri.greater_speed(force)), 1).expect("it is one");
        let points = |step: f64| -> Vec<(Special, f64)> {
            let along = Along { from: force, to: to * least, step, points: 2000 };
            let systems = |force: f64| Ok::<HybridSystem, Infallible>(masri.system(force));
            let branch = Branch::follow(systems, &orbit, force, along).expect("it is followed");
            if let BranchEnd::Graze { parameter } = branch.end {
                // Both contacts lose their speed at once, and what they make of rounding grows as its square.
                close("graze", parameter, masri.force(0.0), 1e-8);
            }
            let special = branch.points.iter().filter_map(|point| Some((point.special?, point.parameter)));
            special.filter(|(kind, _)| *kind != Special::Graze).collect()
        };
        let [fine, coarse] = [0.02, 0.11].map(points);
        assert_eq!(fine.len(), coarse.len(), "ω′ = {ratio}: {fine:?} and {coarse:?}");
        for ((one, here), (other, there)) in fine.into_iter().zip(coarse) {
            assert_eq!(one, other);
            close(one.word(), here, there, 1e-10);
        }
    }
}

/// One mass with a particle between rigid walls, shaken at so many times its own frequency.
fn shaken(ratio: f64, particle: f64, gap: f64, damping_ratio: f64) -> impl Fn(f64) -> Result<HybridSystem, Infallible> {
    let natural = 1000.0_f64.sqrt();
    move |force| {
        let mass = base(1.0, 1000.0, 2.0 * damping_ratio * natural);
        let drive = Excitation::Harmonic { force, angular_frequency: ratio * natural };
        Ok(system(&scene(mass, 0.0, damper(particle, gap, rigid(0.5)), drive)))
    }
}

/// The orbit that a run of so many cycles from rest ends in.
fn settled(system: &HybridSystem, cycles: u32) -> Orbit {
    Orbit::after(system, &Options { skip: cycles - 100, average: 100, ..Options::default() }).expect("it settles")
}

#[test]
fn a_loss_of_symmetry_behind_a_complex_pair_is_found_whatever_the_step() {
    // A pair leaves the unit circle at 40.184 N, becomes real at 40.249 N, and one of the two comes back through 1 at once.
    let systems = shaken(1.3, 0.2, 0.05, 0.05);
    let orbit = settled(&systems(40.0).expect("it compiles"), 500);
    assert_eq!((orbit.cycles, orbit.contacts, orbit.is_stable()), (3, 8, true));
    let found = [0.002, 0.008, 0.01, 0.05].map(|step| {
        let along = Along { from: 5.0, to: 60.0, step, points: 14 };
        let branch = Branch::follow(&systems, &orbit, 40.0, along).expect("it has a first orbit");
        let [torus] = special(&branch, Special::Torus)[..] else { panic!("one torus with steps of {step}") };
        let [fork] = special(&branch, Special::SymmetryBreaking)[..] else { panic!("one fork with steps of {step}") };
        within("multiplier", fork.orbit.multipliers[1].modulus, 1.0, 1e-8);
        assert!(torus.parameter < fork.parameter && fork.orbit.multipliers[0].modulus > 1.03);
        for point in branch.points.iter().filter(|point| point.special.is_none()) {
            let outside = point.orbit.multipliers.iter().filter(|it| it.modulus > 1.0).count();
            let expected = if point.parameter < torus.parameter {
                0
            } else if point.parameter < fork.parameter {
                2
            } else {
                1
            };
            assert_eq!(outside, expected, "at {} N", point.parameter);
        }
        // Two motions begin there, with the harder blows on the one wall or on the other.
        let both = Branch::asymmetric(&systems, fork, Along { points: 4, ..along }).expect("they begin there");
        let harder = both.map(|branch| {
            let events = &branch.points.last().expect("it has points").orbit.response.events;
            let contacts = events.iter().filter(|event| event.kind.is_contact());
            contacts.fold(0.0, |sum, event| sum + event.approach * event.approach.abs())
        });
        assert!(harder[0] * harder[1] < 0.0, "{harder:?}");
        [torus.parameter, fork.parameter]
    });
    for [torus, fork] in found {
        close("torus", torus, found[0][0], 1e-10);
        close("fork", fork, found[0][1], 1e-10);
    }
}

#[test]
fn a_branch_is_not_closed_by_its_own_first_step() {
    // The period begins away from contacts, where rounding moves the first point by less than can be told.
    let systems = shaken(0.8, 0.05, 0.1, 0.02);
    let orbit = settled(&systems(20.0).expect("it compiles"), 500);
    assert_eq!((orbit.cycles, orbit.contacts), (2, 5));
    let along = Along { from: 5.0, to: 60.0, step: 0.01, points: 100 };
    let branch = Branch::follow(&systems, &orbit, 20.0, along).expect("it has a first orbit");
    assert!(matches!(branch.end, BranchEnd::Graze { .. }), "{:?}", branch.end);
    let [doubling] = special(&branch, Special::PeriodDoubling)[..] else { panic!("it doubles its period once") };
    within("multiplier", doubling.orbit.multipliers[0].modulus, 1.0, 1e-9);
}
