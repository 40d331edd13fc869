//! Where options write: `-`, links, pipes, and never over the study's own files.

use std::fs;
use std::os::unix::fs::{FileTypeExt, symlink};
use std::process::Command;

use crate::cli::relative_files;
use crate::desk::{Desk, command, shotdamp, simulated};

fn is_page(text: &str) -> bool {
    text.starts_with("<!DOCTYPE html>") && text.trim_end().ends_with("</html>")
}

#[test]
fn a_dash_is_standard_output_and_nothing_else_goes_there() {
    let desk = simulated();
    let elsewhere = tempfile::tempdir().unwrap();
    for arguments in [&["report", "--html"][..], &["check", "--self-test", "--junit"], &["check", "--markdown"]] {
        let file = elsewhere.path().join(arguments.last().unwrap());
        shotdamp(&desk, &[arguments, &[file.to_str().unwrap()]].concat());
        let document = fs::read_to_string(file).unwrap();
        for name in ["-", "/dev/stdout"] {
            let said = shotdamp(&desk, &[arguments, &[name]].concat());
            assert!(said.out == document, "{arguments:?} {name}:\n{}\n{}", said.out, said.err);
        }
    }
    assert!(!desk.layout.path("-").exists() && !fs::exists("-").unwrap());
    for two in [
        &["check", "--junit", "-", "--markdown", "-"][..],
        &["check", "--json", "--junit", "-"],
        &["check", "--github", "--junit", "-"],
    ] {
        let said = shotdamp(&desk, two);
        assert_eq!((said.code, said.out.as_str()), (2, ""), "{two:?}");
        assert!(said.err.contains("only one document"), "{}", said.err);
    }
}

#[test]
fn a_link_stays_and_what_it_leads_to_is_written() {
    let desk = simulated();
    let elsewhere = tempfile::tempdir().unwrap();
    let [first, second, file] = ["first", "second", "page.html"].map(|name| elsewhere.path().join(name));
    symlink("second", &first).unwrap();
    symlink(&file, &second).unwrap();
    for before in [None, Some("old")] {
        before.iter().for_each(|text| fs::write(&file, text).unwrap());
        assert_eq!(shotdamp(&desk, &["report", "--html", first.to_str().unwrap()]).code, 0);
        assert!(is_page(&fs::read_to_string(&file).unwrap()));
        assert!(first.is_symlink() && second.is_symlink() && !file.is_symlink());
    }
    symlink("circle", elsewhere.path().join("circle")).unwrap();
    let said = shotdamp(&desk, &["report", "--html", elsewhere.path().join("circle").to_str().unwrap()]);
    assert!(said.code == 2 && said.err.contains("its links lead in a circle"), "{}", said.err);
}

#[test]
fn a_pipe_takes_the_bytes_and_stays_a_pipe() {
    let desk = simulated();
    let pipe = desk.layout.path("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let mut writer = command(&desk, &["report", "--html", pipe.to_str().unwrap()]).spawn().unwrap();
    assert!(is_page(&fs::read_to_string(&pipe).unwrap()));
    assert!(writer.wait().unwrap().success());
    assert!(fs::symlink_metadata(&pipe).unwrap().file_type().is_fifo());
}

#[test]
fn what_a_study_is_read_from_and_what_a_run_writes_is_never_overwritten() {
    let desk = Desk::new();
    assert_eq!(shotdamp(&desk, &["run", "--quiet"]).err, "");
    desk.put("study.yaml", "title: Mine\n");
    let elsewhere = tempfile::tempdir().unwrap();
    let link = elsewhere.path().join("link");
    symlink(desk.layout.path("experiments/ch3"), &link).unwrap();
    let before = relative_files(&desk);
    let inside = [
        "experiments/assumptions.yaml",
        "experiments/ch3/new.html",
        "reference/ch3/../ch3/ch3-gap.yaml",
        "calibrations/page.html",
        "study.yaml",
        "results/ch3-gap.parquet",
        "reports/README.md",
    ];
    let inside = inside.map(|name| desk.layout.path(name));
    for path in inside.iter().chain([&link.join("ch3-gap.yaml")]) {
        let path = path.to_str().unwrap();
        for arguments in [
            &["report", "--html", path][..],
            &["check", "--junit", path],
            &["check", "--markdown", path],
            &["export", "--ro-crate", path],
        ] {
            let said = shotdamp(&desk, arguments);
            assert_eq!((said.code, said.out.as_str()), (2, ""), "{arguments:?}");
            assert!(said.err.contains("of this study, which holds its own files: name another"), "{}", said.err);
        }
    }
    assert!(relative_files(&desk) == before);
}
