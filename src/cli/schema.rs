//! `shotdamp schema`: JSON Schemas for editors.

use clap::ValueEnum;

use super::args::SchemaOf;
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_document};
use crate::atomic::{self, FileError};
use crate::experiment::{
    AssumptionSheet, assumptions_schema, calibration_schema, experiment_schema, load_assumptions, study_schema,
};
use crate::reference::reference_schema;
use crate::study::{ASSUMPTIONS, Layout};

impl SchemaOf {
    /// Where it stands within the study.
    pub fn file(self) -> &'static str {
        match self {
            Self::Study => "schema/study.json",
            Self::Experiment => "schema/experiment.json",
            Self::Assumptions => "schema/assumptions.json",
            Self::Reference => "schema/reference.json",
            Self::Calibration => "schema/calibration.json",
        }
    }

    fn text(self, sheet: &AssumptionSheet) -> String {
        let schema = match self {
            Self::Experiment => experiment_schema(sheet),
            Self::Study => study_schema(),
            Self::Assumptions => assumptions_schema(),
            Self::Reference => reference_schema(),
            Self::Calibration => calibration_schema(sheet),
        };
        format!("{schema:#}\n")
    }
}

/// Prints one schema, as [`write_all`] writes it into this study; outside of a study it offers no names of assumptions.
pub(super) fn print_one(layout: Option<&Layout>, of: SchemaOf) -> Result<Exit, CliError> {
    print_document(&of.text(&layout.map(sheet).unwrap_or_default()))?;
    Ok(Exit::AsExpected)
}

/// Writes all of them.
pub(super) fn write(layout: &Layout) -> Result<Exit, CliError> {
    write_all(layout)?;
    let description: Vec<String> = SchemaOf::value_variants().iter().map(|of| format!("{}\n", of.file())).collect();
    print(&description.concat())?;
    Ok(Exit::AsExpected)
}

/// The assumptions of a study; none while they cannot be read.
fn sheet(layout: &Layout) -> AssumptionSheet {
    load_assumptions(&layout.path(ASSUMPTIONS)).unwrap_or_default()
}

/// Writes those that are not what they should be.
pub(super) fn write_all(layout: &Layout) -> Result<(), FileError> {
    let sheet = sheet(layout);
    for of in SchemaOf::value_variants() {
        atomic::write_if_changed(&layout.path(of.file()), of.text(&sheet).as_bytes())?;
    }
    Ok(())
}
