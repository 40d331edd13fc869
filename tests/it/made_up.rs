//! An experiment and tables made by hand, for rooms that only read them.

use shotdamp::dynamics::{Limit, Until};
use shotdamp::experiment::{
    Axis, AxisScale, Band, Carried, Case, ContactDampingRecipe, DamperRecipe, Drawing, ExcitationKind,
    ExcitationRecipe, Experiment, ExperimentId, FigureSpec, ForcingOrNatural, GapRecipe, Given, ImpulseTimeRecipe,
    MassReading, MassRecipe, MeanRatio, ObserveRecipe, Panel, Parameter, PlaceRecipe, PointsRecipe, Recipe, Reference,
    Source, StiffnessRecipe, StopRecipe, StrengthRecipe, StructureRecipe, SurfaceRecipe, SweptSlots, TimingRecipe,
};
use shotdamp::measure::{Comparison, Measure, NamedRows, Settings, SolverChoice};
use shotdamp::scene::Take;
use shotdamp::table::{Column, Data, Table};

/// The limit stop of section 3.6.3, with one figure of its velocity ratio.
pub fn limit_stop() -> Experiment {
    let floor = SurfaceRecipe::Resilient {
        stiffness: StiffnessRecipe::Ratio(Given::Stated(1.0)),
        untuned_ratio: None,
        damping_curve: None,
        damping: ContactDampingRecipe::Ratio(Given::Assumed("contact_damping_ratio".into())),
        no_tension: false,
    };
    Experiment {
        id: ExperimentId("ch3-limit-stop".into()),
        title: "Limit stop".into(),
        source: Source { chapter: Some(3), section: Some("3.6.3".into()), shown_in: vec!["Fig. 18".into()] },
        about: "Velocity ratio against the forcing amplitude, with and without a stop.".into(),
        recipe: Recipe {
            structure: StructureRecipe::single_mass(1.0, 1000.0, 0.05),
            gravity: Given::Assumed("gravity".into()),
            undamped_mass: Given::Stated(Carried::Base),
            mass_measure: Given::Stated(Comparison::Jump),
            mean_ratio: Given::Stated(MeanRatio::OfMeans),
            dampers: vec![DamperRecipe {
                at: PlaceRecipe::default(),
                array: None,
                mass_reading: Given::Stated(MassReading::Total),
                massless_ratio: None,
                particle_share: Given::Stated(1.0),
                mass: MassRecipe::Ratio(Given::Stated(0.05)),
                gap: GapRecipe::Ratio(Given::Stated(50.0)),
                gap_frequency: Given::Stated(Reference::Clean),
                floor: floor.clone(),
                ceiling: floor,
                stop: Some(StopRecipe {
                    length: Given::Assumed("stop_length".into()),
                    restitution: Given::Assumed("stop_restitution".into()),
                }),
                walls: None,
                swept: SweptSlots::default(),
            }],
            without_dampers: false,
            excitation: ExcitationRecipe {
                kind: ExcitationKind::ImpulseTrain,
                at: PlaceRecipe::default(),
                strength: StrengthRecipe::ForceRatio(Given::Stated(1.0)),
                timing: TimingRecipe::FrequencyRatio(Given::Stated(1.0)),
                frequency_reference: Given::Stated(Carried::Base),
                impulse_time: ImpulseTimeRecipe::Factor {
                    factor: Given::Assumed("impulse_factor".into()),
                    frequency: Given::Stated(ForcingOrNatural::Forcing),
                },
            },
            start: None,
            observe: ObserveRecipe { points: PointsRecipe::Usual, take: Given::Stated(Take::Largest) },
            mode: None,
        },
        cases: vec![Case::default()],
        swept: vec![Parameter::ForceRatio, Parameter::Stop],
        solvers: vec![SolverChoice::EventDriven, SolverChoice::FixedStep { time_step: 1e-4 }],
        settings: Settings {
            skip: 25,
            average: 100,
            until: Until::Cycles,
            round_period_to: None,
            ensemble: 32,
            named: NamedRows::Results,
            mean_of: 0,
        },
        transient: None,
        limit: Limit::default(),
        maximise: None,
        refined: Vec::new(),
        continued: Vec::new(),
        each_cycle: None,
        tolerances: Vec::new(),
        mean_over: Vec::new(),
        optimise: None,
        orbit: None,
        starts: None,
        moved: None,
        measures: vec![Measure::VelocityRatio],
        trace: None,
        energies: None,
        shape: None,
        figures: vec![figure(vec![panel("force_ratio", AxisScale::Log, &["velocity_ratio"])])],
        without_source: Vec::new(),
    }
}

pub fn figure(panels: Vec<Panel>) -> FigureSpec {
    drawn(Drawing::Lines(panels))
}

pub fn drawn(drawing: Drawing) -> FigureSpec {
    FigureSpec {
        name: String::new(),
        only: None,
        caption: "Effect of the limit stop on the velocity ratio.".into(),
        drawing,
    }
}

pub fn axis(column: &str, scale: AxisScale) -> Axis {
    Axis { scale, ..Axis::of(column) }
}

/// A panel of these y columns on a linear axis.
pub fn panel(x: &str, scale: AxisScale, y: &[&str]) -> Panel {
    Panel {
        x: axis(x, scale),
        y: y.iter().map(|column| axis(column, AxisScale::Linear)).collect(),
        by: Vec::new(),
        band: Band::None,
        over_first: false,
        guides: Vec::new(),
        markers: false,
        peaks: None,
        strip: None,
        joined: shotdamp::experiment::Joined::ByX,
    }
}

pub fn numbers(name: &str, symbol: &str, unit: &str, cells: Vec<f64>) -> Column {
    Column::new(name, Data::Float(cells)).with_symbol(symbol).with_unit(unit)
}

pub fn texts(name: &str, cells: impl IntoIterator<Item = &'static str>) -> Column {
    Column::new(name, Data::Text(cells.into_iter().map(str::to_owned).collect()))
}

/// `count` numbers from `from` to `to`, evenly spaced on a logarithmic axis.
pub fn log_range(from: f64, to: f64, count: u32) -> Vec<f64> {
    let ratio = (to / from).ln();
    (0..count).map(|i| from * (ratio * f64::from(i) / f64::from(count - 1)).exp()).collect()
}

/// A velocity ratio as the study describes it: 1 at both ends, a maximum in between.
pub fn hump(x: f64, at: f64, height: f64) -> f64 {
    1.0 + height * (-(x / at).ln().powi(2) / 0.9).exp()
}

/// With and without stop, under both solvers; a chaotic stretch, a gap, and one row with an assumption moved.
pub fn limit_stop_table() -> Table {
    let amplitudes = log_range(0.1, 100.0, 61);
    let lines = [
        ("with", "event_driven", 0.0),
        ("without", "event_driven", 0.18),
        ("with", "fixed_step_1e-4s", 0.03),
        ("without", "fixed_step_1e-4s", 0.21),
    ];
    let mut force = Vec::new();
    let (mut stop, mut solver, mut variant) = (Vec::new(), Vec::new(), Vec::new());
    let (mut ratio, mut spread, mut chaotic) = (Vec::new(), Vec::new(), Vec::new());
    for (with, by, shift) in lines {
        for (i, &f) in amplitudes.iter().enumerate() {
            let wild = (1.5..9.0).contains(&f);
            let noise = if wild { 0.12 * (37.0 * f).sin() } else { 0.0 };
            let fall = if with == "with" && f > 2.2 { 0.3 * (f / 2.2).ln().min(1.0) } else { 0.0 };
            force.push(f);
            stop.push(with);
            solver.push(by);
            variant.push("baseline");
            ratio.push(if i == 50 && with == "with" { f64::NAN } else { hump(f, 2.5, 2.3) + noise + fall - shift });
            spread.push(if wild { 0.22 } else { 0.0 });
            chaotic.push(i64::from(wild));
        }
    }
    force.push(2.5);
    stop.push("with");
    solver.push("event_driven");
    variant.push("stop_length=0.05");
    ratio.push(1e6);
    spread.push(0.0);
    chaotic.push(0);
    let rows = force.len();
    let flat = |name, value| numbers(name, "", "", vec![value; rows]);
    let count = |name, value| Column::new(name, Data::Int(vec![value; rows]));
    Table::default()
        .with(numbers("force_ratio", "f′", "", force))
        .with(texts("stop", stop))
        .with(texts("solver", solver))
        .with(texts("variant", variant))
        .with(numbers("velocity_ratio", "ψ", "", ratio))
        .with(flat("velocity_ratio_num", 1.3e-13))
        .with(numbers("velocity_ratio_spread", "", "", spread))
        .with(flat("momentum_residual", 2.4e-14))
        .with(flat("energy_residual", 7.1e-14))
        .with(count("events", 490))
        .with(numbers("smallest_margin", "", "m", vec![3.2e-9; rows]))
        .with(count("ties", 0))
        .with(Column::new("chaotic", Data::Int(chaotic)))
        .with(count("members", 32))
        .with(texts("failure", vec![""; rows]))
}
