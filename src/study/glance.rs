//! A file as it was last seen: enough to notice that it was cut, replaced or edited, at the price of one `stat`.
//!
//! Size, inode and both times of a file stay the same only if nobody has written to it, except within the resolution of the
//! times themselves. A file that was written just before it was looked at is therefore compared by content the next time.

use std::fs::{File, Metadata};
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};

/// Files whose first and last bytes are enough: a Parquet file ends with the checksum over all its bytes and a PNG with the
/// one over all its pixels; a record repeats only what its inputs say. Reports are read whole.
const HEAD_AND_TAIL: [&str; 3] = ["parquet", "png", "json"];
/// Length of head and tail.
const LOOK: usize = 4 << 10;
/// No file system in use has coarser times.
const RESOLUTION: Duration = Duration::from_secs(2);

/// A file as it was seen.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Glance {
    bytes: u64,
    content: [u8; 32],
    stamp: Option<Stamp>,
}

/// What the system changes whenever a file is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
struct Stamp {
    inode: u64,
    modified: (i64, i64),
    changed: (i64, i64),
}

/// How a file compares with what was seen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Match {
    /// Nobody has written to it.
    Untouched,
    /// It was written to, or may have been, and holds the same; as it is seen now.
    Same(Glance),
    /// It is another, or is gone.
    Different,
}

impl Glance {
    /// Looks at a file.
    ///
    /// # Errors
    /// The system's, if it cannot be read.
    pub fn at(path: &Path) -> std::io::Result<Self> {
        let mut file = File::open(path)?;
        let metadata = file.metadata()?;
        let stamp = settled_stamp(&metadata);
        let bytes = metadata.len();
        let short = path.extension().is_some_and(|extension| HEAD_AND_TAIL.iter().any(|one| extension == *one));
        let length = usize::try_from(bytes).map_err(std::io::Error::other)?;
        let mut seen = vec![0; if short { length.min(2 * LOOK) } else { length }];
        let (head, tail) = seen.split_at_mut(length.min(LOOK));
        file.read_exact(head)?;
        if short && length > 2 * LOOK {
            file.seek(SeekFrom::Start(bytes - LOOK as u64))?;
        }
        file.read_exact(tail)?;
        Ok(Self { bytes, content: *blake3::hash(&seen).as_bytes(), stamp })
    }

    /// Compares the file with what was seen; `taken` is when that was written down.
    #[must_use]
    pub fn compare(&self, path: &Path, taken: SystemTime) -> Match {
        let Ok(metadata) = std::fs::metadata(path) else { return Match::Different };
        if metadata.len() != self.bytes {
            return Match::Different;
        }
        if self.stamp.is_some() && stamp(&metadata) == self.stamp {
            return Match::Untouched;
        }
        // The middle of a large file is not read: one that was written to since then is compared in full by the plan.
        if metadata.modified().map_or(true, |modified| modified > taken) {
            return Match::Different;
        }
        match Self::at(path) {
            Ok(now) if now.bytes == self.bytes && now.content == self.content => Match::Same(now),
            _ => Match::Different,
        }
    }

    /// True if one `stat` will do the next time.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        self.stamp.is_some()
    }
}

/// The stamp, unless the file was written so recently that another write could leave the same one.
fn settled_stamp(metadata: &Metadata) -> Option<Stamp> {
    let stamp = stamp(metadata)?;
    let long_ago = SystemTime::now().checked_sub(RESOLUTION)?.duration_since(SystemTime::UNIX_EPOCH).ok()?;
    let long_ago = i64::try_from(long_ago.as_secs()).ok()?;
    (stamp.modified.0 < long_ago && stamp.changed.0 < long_ago).then_some(stamp)
}

#[cfg(unix)]
#[expect(clippy::unnecessary_wraps, reason = "other systems have none")]
fn stamp(metadata: &Metadata) -> Option<Stamp> {
    use std::os::unix::fs::MetadataExt;
    Some(Stamp {
        inode: metadata.ino(),
        modified: (metadata.mtime(), metadata.mtime_nsec()),
        changed: (metadata.ctime(), metadata.ctime_nsec()),
    })
}

#[cfg(not(unix))]
fn stamp(_metadata: &Metadata) -> Option<Stamp> {
    None
}
