//! Parts of a scene.

/// A part of a scene that a refusal is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// The structure.
    Structure,
    /// A damper, by its place in the file.
    Damper(usize),
    /// The excitation.
    Excitation,
    /// What is observed.
    Observe,
    /// Initial conditions.
    Start,
}

impl Part {
    /// Words by which its place is written, or swept.
    pub(crate) fn place_keys(self) -> &'static [&'static str] {
        match self {
            Self::Damper(_) => &["at", "damper_x", "damper_y", "place"],
            Self::Excitation => &["at", "force_x", "force_y", "place"],
            Self::Structure | Self::Observe | Self::Start => &[],
        }
    }

    /// Any damper stands for all of them.
    pub(crate) fn kind(self) -> Self {
        if let Self::Damper(_) = self { Self::Damper(0) } else { self }
    }
}
