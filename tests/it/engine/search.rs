//! A search for scenes that break the engine: chance first, then small steps from the worst scene so far.
//!
//! `cargo test --test it search -- --ignored --nocapture` looks for `SHOTDAMP_SEARCH_SECONDS` (60) and prints what it finds. A
//! scene is bad if a balance does not close, if the engine gives up, or if it ends elsewhere than the solver of many digits. What it finds
//! is to stand below, as tests.

use std::time::{Duration, Instant};

use shotdamp::dynamics::{Law, Options, event_driven};
use shotdamp::scene::{Damper, Excitation, LimitStop, Scene, Surface};

use super::arrays::{Dice, cycles};
use super::bench::{GRAVITY, base, resilient, resilient_without_tension, rigid, system};

#[test]
pub(super) fn cells_and_windows_decide_the_same_events() {
    // Windows half as long are asked alone; of forty particles more guards are set than cells take.
    for count in [1_u32, 2, 3, 40] {
        let damper = |i: u32| {
            let mass = 0.05 / f64::from(1 + i);
            Damper::between(resilient(1000.0, 0.6 * (1000.0 * mass).sqrt()), mass, 0.1 + 0.03 * f64::from(i))
        };
        let drive = Excitation::ImpulseTrain { impulse: 1.5, period: 0.199 };
        let scene = Scene::on_one_mass(base(1.0, 1000.0, 3.0), GRAVITY, (0..count).map(damper).collect(), drive);
        let events = |window_factor| {
            let options = Options { window_factor, record_events: usize::MAX, ..cycles(4) };
            event_driven(&system(&scene), &options).expect("it runs").events
        };
        let (by_cells, by_windows) = (events(1.0), events(0.5));
        assert_eq!(by_cells.len(), by_windows.len(), "{count} particles");
        for (one, other) in by_cells.iter().zip(&by_windows) {
            assert_eq!((one.cycle, one.particle, one.kind), (other.cycle, other.particle, other.kind));
            assert!((one.time - other.time).abs() < 1e-9, "{count} particles: {one:?} for {other:?}");
        }
    }
}

/// A scene of one mass and up to two dampers, by numbers between 0 and 1.
const GENES: usize = 22;

type Genes = [f64; GENES];

fn ratio(gene: f64, low: f64, high: f64) -> f64 {
    low * (high / low).powf(gene)
}

fn surface(genes: &[f64], mass: f64) -> Surface {
    let stiffness = ratio(genes[1], 1.0, 1e9);
    // Up to three times critical.
    let damping = 3.0 * genes[2] * 2.0 * (stiffness * mass).sqrt();
    match genes[0] {
        ..0.4 => resilient(stiffness, damping),
        0.4..0.6 => resilient_without_tension(stiffness, damping),
        0.6..0.8 => rigid(0.0),
        // Not beyond, where chatter takes millions of bounces.
        _ => rigid(0.99 * genes[2]),
    }
}

fn build(genes: &Genes) -> Scene {
    let damping = if genes[0] < 0.1 { 0.0 } else { ratio(genes[0], 1e-3, 1e3) };
    let count = if genes[1] < 0.5 { 1 } else { 2 };
    let dampers = (0..count).map(|i| {
        let genes = &genes[4 + 9 * i..];
        let mass = ratio(genes[0], 1e-6, 1e2);
        let gap = if genes[1] < 0.05 { 0.0 } else { ratio(genes[1], 1e-9, 10.0) };
        let stop = (genes[8] < 0.2).then(|| LimitStop { length: ratio(5.0 * genes[8], 1e-6, 1e-1), restitution: 0.3 });
        Damper { stop, ceiling: surface(&genes[5..], mass), ..Damper::between(surface(&genes[2..], mass), mass, gap) }
    });
    Scene::on_one_mass(
        base(1.0, 1000.0, damping),
        GRAVITY,
        dampers.collect(),
        Excitation::ImpulseTrain { impulse: ratio(genes[2], 1e-6, 1e3), period: ratio(genes[3], 1e-3, 10.0) },
    )
}

/// How bad a scene is: 1 for the first that counts.
fn badness(genes: &Genes) -> (f64, String) {
    let scene = build(genes);
    let system = system(&scene);
    let options = Options { record_events: 0, ..cycles(5) };
    let response = match event_driven(&system, &options) {
        Ok(response) => response,
        // Said, with the reason: modes that cannot be told apart.
        Err(error) => return (1e3, error.to_string()),
    };
    let proof = response.proof;
    let balance = (proof.momentum_residual / 1e-9).max(proof.energy_residual / 1e-9);
    let mut worst = (balance, format!("{proof:?}"));
    let is_known = |particle: &shotdamp::dynamics::Particle| {
        let faces = [Some(&particle.floor), particle.ceiling.as_ref()];
        faces.into_iter().flatten().all(|face| match face.law {
            Law::Rigid { restitution } => restitution == 0.0,
            // Stiffer ones take it too long, and bounces on a stop that die out are no end to it.
            Law::Resilient { no_tension, stiffness, stop, .. } => {
                !no_tension && stiffness < 1e5 && stop.is_none_or(|stop| stop.restitution == 0.0)
            }
        })
    };
    if balance < 1.0
        && proof.events < 500
        && system.particles.iter().all(is_known)
        && let Some([error, bound]) = super::properties::disagreement(&system, &Options { average: 2, ..options })
    {
        let share = 0.1 * error / bound;
        if share > worst.0 {
            worst = (share, format!("ends {error:e} off, {bound:e} allowed"));
        }
    }
    worst
}

#[test]
#[ignore = "a search, not a test: it takes as long as it is given"]
fn search_for_scenes_that_break_the_engine() {
    let seconds = std::env::var("SHOTDAMP_SEARCH_SECONDS").ok().and_then(|text| text.parse().ok()).unwrap_or(60);
    let seed = std::env::var("SHOTDAMP_SEARCH_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(1);
    let (begun, mut dice) = (Instant::now(), Dice(seed));
    let (mut tried, mut found) = (0_u64, 0_u64);
    while begun.elapsed() < Duration::from_secs(seconds) {
        let mut best: Genes = std::array::from_fn(|_| dice.between(0.0, 1.0));
        let mut worst = badness(&best).0;
        // As long as steps make it worse, and some more.
        let mut idle = 0;
        while idle < 12 && worst < 1.0 && begun.elapsed() < Duration::from_secs(seconds) {
            let size = ratio(dice.between(0.0, 1.0), 1e-6, 0.3);
            let mut next = best;
            for gene in &mut next {
                if dice.chance(0.3) {
                    *gene = (*gene + size * dice.between(-1.0, 1.0)).clamp(0.0, 1.0);
                }
            }
            let now = badness(&next).0;
            tried += 1;
            idle += 1;
            if now > worst {
                (best, worst, idle) = (next, now, 0);
            }
        }
        if worst >= 1.0 {
            found += 1;
            println!("{worst:e}: {}\n  {best:?}", badness(&best).1);
        }
    }
    println!("{tried} scenes tried, {found} found");
}
