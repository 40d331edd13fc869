//! Other solvers as programs: how they are got ready, asked and understood.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::scene::Told;

/// Libraries that the program in C is linked with.
const LIBRARIES: [&str; 7] = [
    "-lsundials_cvode",
    "-lsundials_nvecserial",
    "-lsundials_sunmatrixdense",
    "-lsundials_sunlinsoldense",
    "-lsundials_sunnonlinsolfixedpoint",
    "-lsundials_generic",
    "-lm",
];

/// Peers that look for a periodic motion by shooting.
const SHOOTING: [&str; 2] = ["diffsol", "SciPy"];

/// Another solver.
pub struct Peer {
    /// As the tables call it.
    pub name: &'static str,
    /// How it is started, or why it cannot be.
    program: Result<Vec<PathBuf>, String>,
    /// Of the files that describe a scene, the one that it reads.
    reads: &'static str,
}

/// What a peer says of a scene.
#[derive(Debug, Clone)]
pub struct Answer {
    /// The peer.
    pub peer: &'static str,
    /// The file that it was asked about.
    pub file: String,
    /// Its method.
    pub method: String,
    /// With its tolerance.
    pub setting: String,
    /// The result, or why there is none.
    pub outcome: Result<Run, String>,
}

/// One result.
#[derive(Debug, Clone)]
pub struct Run {
    pub rms: f64,
    pub events: Vec<Told>,
    /// s, ascending.
    pub times: Vec<f64>,
}

impl Peer {
    /// All of them, compiled where they have to be.
    pub fn all(root: &Path, scratch: &Path) -> Vec<Self> {
        let scripts = root.join("benches/peers");
        let python = std::env::var_os("SHOTDAMP_PEERS_PYTHON").map_or_else(|| PathBuf::from("python3"), PathBuf::from);
        let script = |name: &str| Ok(vec![python.clone(), "-B".into(), scripts.join(name)]);
        let of = |name, program, reads| Self { name, program, reads };
        std::fs::create_dir_all(scratch).expect("target can be written");
        vec![
            of("CVODE", in_c(&scripts, scratch), "txt"),
            of("diffsol", in_rust(&scripts, scratch), "json"),
            of("SciPy", script("scipy_events.py"), "json"),
            of("scikit-sundae", script("cvode_events.py"), "json"),
            of("numba", script("numba_fixed.py"), "json"),
        ]
    }

    /// A scene in all settings, repeatedly.
    pub fn timed(&self, scene: &Path) -> Vec<Answer> {
        self.ask(&[], &[scene.to_owned()])
    }

    /// The periodic motion of a scene in all settings, repeatedly; of peers that look for one.
    pub fn orbit(&self, scene: &Path) -> Vec<Answer> {
        if SHOOTING.contains(&self.name) { self.ask(&["--orbit".as_ref()], &[scene.to_owned()]) } else { Vec::new() }
    }

    /// Each scene once, in the tightest settings.
    pub fn tightest(&self, scenes: &[PathBuf]) -> Vec<Answer> {
        self.ask(&["--tightest".as_ref()], scenes)
    }

    fn ask(&self, words: &[&OsStr], scenes: &[PathBuf]) -> Vec<Answer> {
        let scenes = scenes.iter().map(|scene| scene.with_extension(self.reads));
        let failed = |why: String| {
            let name = self.name.to_owned();
            vec![Answer {
                peer: self.name,
                file: String::new(),
                method: name.clone(),
                setting: name,
                outcome: Err(why),
            }]
        };
        let program = match &self.program {
            Err(why) => return failed(why.clone()),
            Ok(program) => program,
        };
        // One thread, as the others.
        let threads = ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"].map(|name| (name, "1"));
        let output = Command::new(&program[0]).args(&program[1..]).args(words).args(scenes).envs(threads).output();
        let output = match output {
            Err(error) => return failed(error.to_string()),
            Ok(output) => output,
        };
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let lines = text.lines().filter_map(|line| serde_json::from_str(line).ok());
        let answers: Vec<Answer> = lines.map(|line: Value| Answer::read(self.name, &line)).collect();
        if answers.is_empty() { failed(last_line(&output.stderr)) } else { answers }
    }
}

impl Answer {
    fn read(peer: &'static str, line: &Value) -> Self {
        let text = |key: &str| line[key].as_str().unwrap_or_default().to_owned();
        let outcome = match line["failure"].as_str() {
            Some(why) => Err(why.to_owned()),
            None => Run::read(line).ok_or_else(|| "no number".to_owned()),
        };
        Self { peer, file: text("file"), method: text("solver"), setting: text("setting"), outcome }
    }
}

impl Run {
    fn read(line: &Value) -> Option<Self> {
        let event = |event: &Value| {
            let particle = usize::try_from(event[1].as_u64()?).ok()?;
            Some(Told { time: event[0].as_f64()?, particle, word: event[2].as_str()?.to_owned() })
        };
        let events = line["events"].as_array()?.iter().map(event).collect::<Option<Vec<_>>>()?;
        let mut times: Vec<f64> = line["times"].as_array()?.iter().filter_map(Value::as_f64).collect();
        times.sort_by(f64::total_cmp);
        Some(Self { rms: line["rms"].as_f64()?, events, times })
    }
}

/// The program in C, compiled as portably as this one is.
fn in_c(sources: &Path, scratch: &Path) -> Result<Vec<PathBuf>, String> {
    let program = scratch.join("cvode");
    let mut compiler = Command::new("cc");
    compiler.arg("-O3").arg("-o").arg(&program).arg(sources.join("cvode.c")).args(LIBRARIES);
    done(&mut compiler)?;
    Ok(vec![program])
}

fn in_rust(sources: &Path, scratch: &Path) -> Result<Vec<PathBuf>, String> {
    let target = scratch.join("diffsol");
    let manifest = sources.join("diffsol/Cargo.toml");
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut build = Command::new(cargo);
    build.args(["build", "--release", "--locked", "--manifest-path"]).arg(manifest).arg("--target-dir").arg(&target);
    done(&mut build)?;
    Ok(vec![target.join("release/diffsol-events")])
}

fn done(command: &mut Command) -> Result<(), String> {
    let output = command.output().map_err(|error| error.to_string())?;
    if output.status.success() { Ok(()) } else { Err(last_line(&output.stderr)) }
}

fn last_line(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).lines().last().unwrap_or("no answer").to_owned()
}
