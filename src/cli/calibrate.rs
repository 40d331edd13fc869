//! `shotdamp calibrate ID`.

use super::args::{Args, CalibrateArgs};
use super::error::CliError;
use super::exit::Exit;
use super::output::{complain_of, print};
use super::select::open;
use crate::atomic;
use crate::report;
use crate::spec::{Experiment, ExperimentId, load_calibration};
use crate::study::{Engine, Layout, Listen, Progress, Silence};

/// Runs a calibration, prints what it found, and writes its page.
pub(super) fn calibrate(layout: &Layout, args: &CalibrateArgs, common: &Args) -> Result<Exit, CliError> {
    let id: ExperimentId = args.id.parse()?;
    let calibration = load_calibration(&layout.path(&format!("calibrations/{id}.yaml")))?;
    let opened = open(layout)?;
    complain_of(&opened.unread);
    let experiments: Vec<&Experiment> = opened.items.iter().map(|item| &item.source.experiment).collect();
    let in_force = opened.sheet.assumptions();
    let progress = Progress::new();
    let listener: &dyn Listen = if common.quiet { &Silence } else { &progress };
    let references = &opened.references;
    let result = crate::calibrate::calibrate(
        &calibration,
        &experiments,
        references,
        &in_force,
        common.threads(),
        &Engine,
        listener,
    )?;
    let page = report::calibration(&calibration, &result);
    atomic::write_if_changed(&layout.path(&format!("reports/calibrations/{id}.md")), page.as_bytes())?;
    print(&page)?;
    Ok(if result.best.is_some() { Exit::AsExpected } else { Exit::CouldNot })
}
