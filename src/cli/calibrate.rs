//! `shotdamp calibrate ID`.

use super::args::{Args, CalibrateArgs};
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_unread};
use super::select::{hint, open};
use crate::atomic;
use crate::calibrate::{Running, calibration as calibration_page};
use crate::experiment::{Experiment, ExperimentId};
use crate::study::{Engine, EventHandler, IgnoreEvents, Layout, LeftOutRecord, Progress, calibration_journal_name};

/// Runs a calibration, prints what it found, and writes its page.
pub(super) fn calibrate(layout: &Layout, args: &CalibrateArgs, common: &Args) -> Result<Exit, CliError> {
    let id: ExperimentId = args.id.parse()?;
    let mut study = open(layout)?;
    let known = study.texts.calibrations();
    if !known.contains(id.0.as_str()) {
        return Err(CliError::NoCalibration { hint: hint(&id.0, &known, "ls calibrations"), id: id.0 });
    }
    // Before hours of work, not after them.
    let page_name = format!("reports/calibrations/{id}.md");
    atomic::check_writable(&layout.path(&page_name))?;
    args.limit.apply(&mut study);
    print_unread(&study.unread);
    let Some(calibration) = study.calibrations.get(&id.0) else { return Ok(Exit::CouldNot) };
    let experiments: Vec<&Experiment> = study.items.iter().map(|item| &item.source.experiment).collect();
    let in_force = study.sheet.assumptions();
    let progress = Progress::new();
    let handler: &dyn EventHandler = if common.quiet { &IgnoreEvents } else { &progress };
    let references = &study.references;
    let result = crate::calibrate::calibrate(
        calibration,
        &experiments,
        references,
        &in_force,
        Running { threads: common.threads(), journal: Some(&layout.path(&calibration_journal_name(&id))) },
        &Engine,
        handler,
    )?;
    let page = calibration_page(calibration, &result);
    atomic::write_if_changed(&layout.path(&page_name), page.as_bytes())?;
    if calibration.leave_one_out {
        let predicted = result.left_out.iter().filter(|one| one.tells_sets_apart());
        let errors = predicted.map(|one| (one.id.clone(), one.errors)).collect();
        let record = LeftOutRecord::of(calibration, errors);
        atomic::write_if_changed(&layout.path(&LeftOutRecord::name(&id.0)), record.text().as_bytes())?;
    }
    print(&page)?;
    Ok(if result.best.is_some() { Exit::AsExpected } else { Exit::CouldNot })
}
