//! The whole process with nothing to do, over as many experiments as the study will have.

use std::process::Command;

use shotdamp::study::IgnoreEvents;

#[path = "../tests/it/desk.rs"]
#[expect(dead_code, reason = "a bench needs only a part of it")]
mod desk;

use desk::{Desk, GAP, GAP_REFERENCE, MadeUp};

/// Rows of the study's inventory.
const EXPERIMENTS: usize = 63;

fn main() {
    divan::main();
}

#[divan::bench(sample_count = 100)]
fn nothing_to_do(bencher: divan::Bencher<'_, '_>) {
    let desk = Desk::new();
    // Two are there already.
    for copy in 2..EXPERIMENTS {
        desk.put(&format!("experiments/ch3/ch3-gap-{copy}.yaml"), GAP);
        desk.put(&format!("reference/ch3/ch3-gap-{copy}.yaml"), GAP_REFERENCE);
    }
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    let mut command = Command::new(env!("CARGO_BIN_EXE_shotdamp"));
    command.arg("--root").arg(desk.folder.path());
    let mut said = || {
        let output = command.output().expect("the program starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    assert!(said().starts_with(&format!("{EXPERIMENTS} experiments: 0 simulated")), "the first run publishes");
    assert!(said().starts_with("Nothing to do."), "the second has nothing to do");
    bencher.bench_local(|| command.output());
}
