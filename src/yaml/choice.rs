//! One of several named forms that is read or described: see [`At`].

use std::cell::Cell;

use super::at::{At, Sketch};
use super::diagnostic::Findings;
use super::keys::Keys;
use super::reader;

/// What was chosen among named forms, or one of those that may be chosen.
pub(crate) enum Choice<'t> {
    Read(reader::Choice<'t>, &'t Findings),
    Sketch(&'static str, &'t Sketch<'t>, &'t Cell<bool>),
}

impl<'t> Choice<'t> {
    /// The name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Read(choice, _) => choice.name,
            Self::Sketch(name, ..) => name,
        }
    }

    /// The word alone, without values.
    pub fn bare(&self) -> Option<()> {
        match self {
            Self::Read(choice, findings) => choice.bare(findings).map(|_| ()),
            Self::Sketch(.., bare) => {
                bare.set(true);
                None
            }
        }
    }

    /// It is the word alone, which it may be.
    pub fn is_bare(&self) -> bool {
        match self {
            Self::Read(choice, _) => choice.content.is_none(),
            Self::Sketch(.., bare) => {
                bare.set(true);
                false
            }
        }
    }

    /// The mapping behind the colon.
    pub fn keys(&self, what: &'static str) -> Option<Keys<'t>> {
        match self {
            Self::Read(choice, findings) => Keys::open(choice.values(findings)?, what, &[], findings),
            Self::Sketch(_, content, _) => Some(Keys::outline(content)),
        }
    }

    /// What stands behind the colon, which must be there.
    pub fn value(&self) -> Option<At<'t>> {
        match self {
            Self::Read(choice, findings) => Some(At::Node(choice.values(findings)?, findings)),
            Self::Sketch(_, content, _) => Some(At::Sketch(content)),
        }
    }

    /// What stands behind the colon, if anything does.
    pub fn content(&self) -> Option<At<'t>> {
        match self {
            Self::Read(choice, findings) => choice.content.map(|node| At::Node(node, findings)),
            Self::Sketch(_, content, _) => Some(At::Sketch(content)),
        }
    }
}
