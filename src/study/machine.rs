//! The machine that times were measured on.

use serde::{Deserialize, Serialize};

/// What times were measured on.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Machine {
    /// Its processor, as it calls itself.
    pub processor: String,
    /// Threads that it runs at once.
    pub threads: usize,
    /// `linux, x86_64`.
    pub system: String,
    /// How the program was built.
    pub build: String,
}

impl Machine {
    /// This one.
    #[must_use]
    pub fn here() -> Self {
        let known = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let name = known.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
        let build = if cfg!(debug_assertions) { "development build" } else { "release build" };
        Self {
            processor: name.map_or_else(|| "unknown".into(), |(_, name)| name.trim().into()),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            system: format!("{}, {}", std::env::consts::OS, std::env::consts::ARCH),
            build: build.into(),
        }
    }
}
