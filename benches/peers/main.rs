//! What a user would otherwise pick, on the same scenes in the same run: `cargo bench --bench peers` writes
//! `reports/accuracy/peers.md` with its diagrams, and `reports/accuracy/peers-events.md`; with the name of a part, `single`,
//! `beam`, `orbit` or `events`, only what belongs to it. `benches/peers/README.md` says what the peers need.
//!
//! Every answer counts only by its numbers: RMS velocity, the sequence of events and their times.

#[path = "../common/mod.rs"]
mod common;
mod events;
mod peer;
mod price;
mod scene;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use peer::Peer;
use price::{picture, ratios, table};
use scene::Scene;
use shotdamp::dynamics::{Options, event_driven};
use shotdamp::study::Machine;

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let wanted: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let is_wanted = |part: &str| wanted.is_empty() || wanted.iter().any(|word| word == part);
    let pages = Pages { folder: root.join("reports/accuracy"), scenes: root.join("target/peers") };
    std::fs::create_dir_all(&pages.folder).expect("reports can be written");
    let peers = Peer::all(root, &pages.scenes);
    if is_wanted("events") {
        pages.write("peers-events.md", events::page(&peers, &pages.scenes).as_bytes());
    }
    let single = common::SINGLE.replace("PERIOD", "period: 0.199 s");
    if is_wanted("orbit") {
        pages.write("peers-orbit.md", orbit(&peers, &single, &pages.scenes).as_bytes());
    }
    if !is_wanted("single") && !is_wanted("beam") {
        return;
    }
    let mut page = introduction();
    let beam = common::BEAM.replace("MODES", "4").replace("DAMPING", "damping_ratio: 0.4");
    for (part, name, text, cycles) in [
        ("single", "One mass, one damper, 125 impulses", single, [25, 100]),
        ("beam", "Beam of four modes, four dampers, 5 impulses", beam, [0, 5]),
    ] {
        if !is_wanted(part) {
            continue;
        }
        let scene = Scene::of_many_digits(&text, cycles);
        let described = scene.describe(&pages.scenes.join(part));
        let mut answers = price::ours(&scene);
        for peer in &peers {
            answers.extend(peer.timed(&described).into_iter().map(|description| price::of_peer(&scene, description)));
        }
        pages.write(&format!("peers-{part}.png"), &picture(&text, &answers));
        let _ = writeln!(page, "## {name}\n\n![Error against wall time](peers-{part}.png)\n");
        page += &table(&answers);
        page += &ratios(&answers);
    }
    pages.write("peers.md", page.as_bytes());
}

/// One periodic motion: ours by Newton on its events, theirs by shooting.
fn orbit(peers: &[Peer], text: &str, scenes: &Path) -> String {
    let run = Scene::of_many_digits(text, [25, 100]);
    let described = run.describe(&scenes.join("orbit"));
    let scene = run.settled();
    let options = Options { final_state: true, ..run.options };
    let near = event_driven(&run.system, &options).expect("it runs").final_state.expect("it was asked for");
    let mut answers = vec![price::our_orbit(&scene, &near)];
    for peer in peers {
        answers.extend(peer.orbit(&described).into_iter().map(|answer| price::of_peer(&scene, answer)));
    }
    let machine = Machine::here();
    format!(
        "# Peers: one periodic motion\n\n[Peers on whole runs](peers.md) · written by `cargo bench --bench peers -- orbit`.\n\n\
         {}, {} threads, {}; {}; one thread.\n\nThe motion that a run of one mass and one damper ends in, from the state at the end of \
         its 125 cycles, which is not timed. Ours is found by Newton's method on its events, and comes with its multipliers. Peers shoot: \
         Newton's method on the map of a cycle, whose matrix is taken by differences of runs and holds the multipliers. Errors of the RMS \
         velocity are against arithmetic of 32 digits after {} cycles.\n\n{}{}",
        machine.processor,
        machine.threads,
        machine.system,
        machine.build,
        scene::SETTLED_AFTER,
        table(&answers),
        ratios(&answers)
    )
}

/// Where pages go, and the scenes that peers read.
struct Pages {
    folder: PathBuf,
    scenes: PathBuf,
}

impl Pages {
    fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.folder.join(name), bytes).expect("reports can be written");
        if name.ends_with(".md") {
            print!("{}", String::from_utf8_lossy(bytes));
        }
    }
}

fn introduction() -> String {
    let machine = Machine::here();
    format!(
        "# Peers\n\n[What accuracy costs](../accuracy.md) · [the same peers on hard sequences of events](peers-events.md) · [one \
         periodic motion](peers-orbit.md) · written by `cargo bench --bench peers`; `benches/peers` has the programs and says how they are used.\n\n{}, {} threads, {}; {}; \
         every run on one thread.\n\nErrors are against arithmetic of 32 digits. Interpreted peers pay for every call of the \
         equations; their times say what a user of them waits for, not what their methods could do in another language.\n\n",
        machine.processor, machine.threads, machine.system, machine.build
    )
}
