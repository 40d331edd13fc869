//! What is committed and what is handed on tells nothing of when, where and by whom it was made.

use std::fs;
use std::path::{Path, PathBuf};

use shotdamp::study::IgnoreEvents;

use crate::desk::{Desk, MadeUp};

/// Words that only this machine can have put there.
fn words_of_this_machine(more: &[String]) -> Vec<String> {
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default().trim().to_owned();
    let name = |key: &str| std::env::var(key).unwrap_or_default();
    let mut words: Vec<String> = more.to_vec();
    words.extend([
        env!("CARGO_MANIFEST_DIR").to_owned(),
        std::env::temp_dir().display().to_string() + "/",
        name("HOME"),
    ]);
    words.extend(["/home/", "/Users/", "/root/", "/usr/local/"].map(str::to_owned));
    words.extend([host, name("USER")].into_iter().filter(|word| word.len() > 4));
    words.retain(|word| word.len() > 2);
    words
}

/// A date or a time of day, as programs write them: 2024-02-29, 12:34:56.
fn has_stamp(bytes: &[u8]) -> bool {
    let shaped = |window: &[u8], shape: &[u8]| {
        window.iter().zip(shape).all(|(byte, like)| if *like == b'9' { byte.is_ascii_digit() } else { byte == like })
    };
    bytes.windows(10).any(|window| shaped(window, b"2099-99-99") && window[5] <= b'1')
        || bytes.windows(8).any(|window| shaped(window, b"99:99:99"))
}

fn assert_clean(name: &str, bytes: &[u8], words: &[String]) {
    assert!(!has_stamp(bytes), "{name} holds a date or a time of day");
    for word in words {
        let found = bytes.windows(word.len()).position(|window| window == word.as_bytes());
        assert_eq!(found, None, "{name} holds {word}");
    }
}

fn below(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() { found.extend(below(&path)) } else { found.push(path) }
    }
    found.sort();
    found
}

/// The kinds of a PNG's chunks; text and time would be `tEXt`, `iTXt`, `zTXt`, `tIME`.
fn chunks(png: &[u8]) -> Vec<String> {
    let mut kinds = Vec::new();
    let mut at = 8;
    while let Some(head) = png.get(at..at + 8) {
        kinds.push(String::from_utf8_lossy(&head[4..]).into_owned());
        at += 12 + u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
    }
    kinds.dedup();
    kinds
}

#[test]
fn reports_tell_no_time_host_or_folder() {
    let words = words_of_this_machine(&[]);
    let reports = below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("reports"));
    assert!(reports.len() > 20, "the committed reports");
    for path in reports {
        let (name, bytes) = (path.display().to_string(), fs::read(&path).unwrap());
        if name.ends_with(".png") {
            let kinds = chunks(&bytes);
            assert!(
                kinds.iter().all(|kind| ["IHDR", "IDAT", "IEND", "PLTE", "pHYs"].contains(&kind.as_str())),
                "{name}: {kinds:?}"
            );
        } else {
            assert_clean(&name, &bytes, &words);
        }
    }
}

#[test]
fn tables_and_records_tell_no_time_host_or_folder() {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    let words = words_of_this_machine(&[desk.folder.path().display().to_string()]);
    for name in ["ch3-gap.parquet", "ch3-gap.json", "ch3-stop.parquet", "ch3-stop.json"] {
        assert_clean(name, &desk.bytes(&format!("results/{name}")), &words);
    }
}

#[test]
fn a_stamp_would_be_found() {
    assert!(has_stamp(b"made 2026-01-31 here") && has_stamp(b"at 23:59:59"));
    assert!(!has_stamp(b"1.2026-5 and 2099-99-9") && !has_stamp(b"1:2:3"));
    assert_eq!(chunks(&[&b"12345678"[..], b"\0\0\0\0IHDRcrc!\0\0\0\x01tIMExcrc!"].concat()), ["IHDR", "tIME"]);
}
