//! Any bytes as an experiment: understood, or refused with a place; never a panic.
//!
//! `cargo +nightly fuzz run experiment fuzz/corpus/experiment experiments/ch3 -- -max_len=4096` begins with those of chapter 3.

#![no_main]

use libfuzzer_sys::fuzz_target;
use shotdamp::experiment::{parse_assumptions, parse_experiment};

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(id) = "ch3-fuzz".parse() else { return };
    let sheet = parse_assumptions("assumptions.yaml", include_str!("../../experiments/assumptions.yaml"));
    let Ok(sheet) = sheet else { return };
    match parse_experiment(&id, "ch3-fuzz.yaml", text, &sheet.assumptions()) {
        // What is understood has a meaning, and means the same when it is asked again.
        Ok(experiment) => assert_eq!(experiment.canonical_json(), experiment.canonical_json()),
        Err(problems) => assert!(!problems.list.is_empty() && !problems.to_string().is_empty()),
    }
});
