//! Figures. Each test leaves its picture in `target/tmp`, to be looked at.

use std::collections::BTreeSet;

use shotdamp::experiment::{
    Axis, AxisScale, AxisUnit, Band, Experiment, FigureSpec, Level, Maximise, Panel, Parameter, PeakMarks, SearchPoint,
    Strip,
};
use shotdamp::figure::{Beside, FigureError, Known, Picture, Quoted, QuotedAt, draw};
use shotdamp::measure::Measure;
use shotdamp::table::{Column, Data, Table};

use crate::made_up::{axis, figure, hump, limit_stop, limit_stop_table, log_range, numbers, panel, texts};

/// Draws, keeps the picture and checks what holds for any of them.
fn picture(name: &str, experiment: &Experiment, spec: &FigureSpec, table: &Table, quoted: &[Quoted]) -> Picture {
    let picture = draw(experiment, spec, table, Beside { quoted, ..Beside::default() }).unwrap();
    let png = &picture.png;
    std::fs::write(format!("{}/{name}.svg", env!("CARGO_TARGET_TMPDIR")), &picture.svg).unwrap();
    std::fs::write(format!("{}/{name}.png", env!("CARGO_TARGET_TMPDIR")), png).unwrap();
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    assert!(png.len() < 250_000, "{name}: {} bytes are too many to commit", png.len());
    assert!(picture.svg.len() < 120_000, "{name}: {} bytes of SVG are too many to commit", picture.svg.len());
    for (text, top) in lines_of_text(&picture.svg) {
        assert!(top > 0.0, "{name}: `{text}` is cut off at the top");
    }
    picture
}

/// The level texts of a drawing with the height of their upper edge.
fn lines_of_text(svg: &str) -> Vec<(String, f64)> {
    let number = |text: &str, name: &str| -> f64 {
        let (_, from) = text.split_once(&format!(" {name}=\"")).unwrap();
        from.split_once('"').unwrap().0.parse().unwrap()
    };
    let level = svg.split("<text").skip(1).filter(|text| !text.contains("rotate("));
    let named = |text: &str| text.split_once('>').and_then(|(_, rest)| rest.split_once('<')).unwrap().0.to_owned();
    level.map(|text| (named(text), number(text, "y") - 0.75 * number(text, "font-size"))).collect()
}

/// Width and height in pixels of the SVG.
fn size(picture: &Picture) -> (u32, u32) {
    let side = |name: &str| {
        let (_, from) = picture.svg.split_once(&format!(" {name}=\"")).unwrap();
        from.split_once('"').unwrap().0.parse().unwrap()
    };
    (side("width"), side("height"))
}

fn amplitude_panel() -> Panel {
    let by = vec!["stop".into(), "solver".into()];
    Panel { by, band: Band::Spread, ..panel("force_ratio", AxisScale::Log, &["velocity_ratio"]) }
}

fn study(column: &str, over: &str, at: QuotedAt) -> Quoted {
    let label = "study: 2.5".into();
    Quoted { column: column.into(), over: Some(over.into()), at, label, u_data: 0.01, tolerance: Some(0.1) }
}

#[test]
fn four_lines_with_the_spread_of_the_ensemble() {
    let guides = vec![Level { at: 1.0, label: "no effect".into() }];
    let spec = figure(vec![Panel { guides, ..amplitude_panel() }]);
    let quoted = [study("velocity_ratio", "force_ratio", QuotedAt::Place(2.5))];
    let png = picture("amplitude", &limit_stop(), &spec, &limit_stop_table(), &quoted);
    // The legend stands above the frame, which is as high as without one.
    assert_eq!(size(&png), (1440, 960 + 150));
}

#[test]
fn the_same_table_gives_the_same_bytes() {
    let (experiment, spec, table) = (limit_stop(), figure(vec![amplitude_panel()]), limit_stop_table());
    let first = draw(&experiment, &spec, &table, Beside::default()).unwrap();
    let threads: Vec<_> = (0..2)
        .map(|_| {
            let (experiment, spec, table) = (experiment.clone(), spec.clone(), table.clone());
            std::thread::spawn(move || draw(&experiment, &spec, &table, Beside::default()).unwrap())
        })
        .collect();
    assert!(threads.into_iter().all(|thread| thread.join().unwrap() == first));
}

#[test]
fn runs_with_an_assumption_moved_are_not_drawn() {
    let spec = figure(vec![amplitude_panel()]);
    let with_variant = limit_stop_table();
    let without = with_variant.select(&with_variant.rows_where("variant", "baseline"));
    assert!(without.rows() < with_variant.rows());
    let experiment = limit_stop();
    assert_eq!(
        draw(&experiment, &spec, &with_variant, Beside::default()),
        draw(&experiment, &spec, &without, Beside::default())
    );
}

/// Base, particle, resilient and rigid surfaces over three forcing cycles.
fn history() -> Table {
    let time: Vec<f64> = (0..=600).map(|i| 51.9 + 1e-3 * f64::from(i)).collect();
    let base: Vec<f64> = time.iter().map(|t| 0.06 * (31.62 * t).sin()).collect();
    let particle: Vec<f64> = time.iter().map(|t| 0.12 + 0.35 * (16.9 * t).sin().abs()).collect();
    let rigid_floor = base.clone();
    let rigid_ceiling: Vec<f64> = base.iter().map(|x| x + 0.49).collect();
    let floor: Vec<f64> = rigid_floor.iter().zip(&particle).map(|(f, p)| f.min(*p - 0.1)).collect();
    let ceiling: Vec<f64> = rigid_ceiling.iter().zip(&particle).map(|(c, p)| c.max(*p + 0.01)).collect();
    let acceleration: Vec<f64> = base.iter().map(|x| -x * 1000.0).collect();
    let half_cycles: Vec<f64> = (0..=600_u32).map(|i| 4.0 + f64::from(i / 100)).collect();
    let damping: Vec<f64> = half_cycles.iter().map(|a| 1.2 + 0.3 * a).collect();
    let list =
        |name: &str, unit: &str, cells: Vec<f64>| Column::new(name, Data::FloatList(vec![cells])).with_unit(unit);
    Table::default()
        .with(texts("variant", ["baseline"]))
        .with(list("time", "s", time))
        .with(list("base_displacement", "m", base))
        .with(list("base_acceleration", "m/s^2", acceleration))
        .with(list("particle_displacement", "m", particle))
        .with(list("floor_displacement", "m", floor))
        .with(list("ceiling_displacement", "m", ceiling))
        .with(list("rigid_floor", "m", rigid_floor))
        .with(list("rigid_ceiling", "m", rigid_ceiling))
        .with(list("rms_acceleration", "g", half_cycles))
        .with(list("contact_damping", "N s/m", damping))
}

#[test]
fn paths_of_particle_and_surfaces_share_a_panel() {
    let paths = ["rigid_floor", "rigid_ceiling", "floor_displacement", "ceiling_displacement", "particle_displacement"];
    let spec = figure(vec![panel("time", AxisScale::Linear, &paths)]);
    picture("paths", &limit_stop(), &spec, &history(), &[]);
}

#[test]
fn panels_stand_above_one_x_axis() {
    let panels = vec![
        panel("time", AxisScale::Linear, &["base_acceleration"]),
        panel("time", AxisScale::Linear, &["rms_acceleration"]),
        panel("time", AxisScale::Linear, &["contact_damping"]),
    ];
    let png = picture("half-cycles", &limit_stop(), &figure(panels), &history(), &[]);
    assert_eq!(size(&png), (1440, 1440));

    let impacts: Vec<i64> = (0..limit_stop_table().rows()).map(|i| i64::try_from(i % 61).unwrap() * 7).collect();
    let table = limit_stop_table().with(Column::new("ceiling_impacts", Data::Int(impacts)));
    let lower = Panel { by: vec!["stop".into()], ..panel("force_ratio", AxisScale::Log, &["ceiling_impacts"]) };
    let table = table.select(&table.rows_where("solver", "event_driven"));
    let png = picture("two-panels", &limit_stop(), &figure(vec![amplitude_panel(), lower]), &table, &[]);
    assert_eq!(size(&png), (1440, 1200 + 72));
}

#[test]
fn a_legend_above_its_panel_stays_on_the_sheet_and_is_not_said_twice() {
    let cases = ["m′ = 0.02, aω²/g = 1.73", "m′ = 0.1, aω²/g = 1.73", "m′ = 0.19, aω²/g = 1.73"];
    let solvers = ["event_driven", "fixed_step"];
    let times = log_range(1e-4, 1e-1, 8);
    let rows: Vec<(&str, &str, f64)> = solvers
        .iter()
        .flat_map(|solver| cases.iter().flat_map(|case| times.iter().map(|time| (*solver, *case, *time))))
        .collect();
    // Points everywhere: no corner is left for a legend.
    let scattered = |row: usize| 10_f64.powf(-15.0 + f64::from(u32::try_from(row * 37 % 72).unwrap()) / 5.0);
    let errors: Vec<f64> = (0..rows.len()).map(scattered).collect();
    // The second case has nothing to show in the lower panel.
    let events = rows.iter().zip(&errors).map(|(row, error)| if row.1 == cases[1] { f64::NAN } else { *error });
    let table = Table::default()
        .with(texts("variant", vec!["baseline"; rows.len()]))
        .with(texts("solver", rows.iter().map(|row| row.0).collect::<Vec<_>>()))
        .with(texts("case", rows.iter().map(|row| row.1).collect::<Vec<_>>()))
        .with(numbers("time", "", "s", rows.iter().map(|row| row.2).collect()))
        .with(numbers("event_error", "", "", events.collect()))
        .with(numbers("error", "", "", errors));
    let one = |column: &str, label: &str| {
        let y = Axis { label: Some(label.into()), ..axis(column, AxisScale::Log) };
        let by = vec!["solver".into(), "case".into()];
        let guides = vec![Level { at: 1e-3, label: "spread of the chaotic motion".into() }];
        Panel { by, y: vec![y], guides, markers: true, ..panel("time", AxisScale::Log, &[]) }
    };
    let below = Panel { guides: Vec::new(), ..one("event_error", "Error of event times / T") };
    let panels = vec![one("error", "Relative error"), below];
    let picture = picture("legend-above", &limit_stop(), &figure(panels), &table, &[]);
    let said = |name: &str| lines_of_text(&picture.svg).iter().filter(|(text, _)| text.ends_with(name)).count();
    assert_eq!(cases.map(said), [1, 1, 1], "each case once, and no case has another look in the lower panel");
}

#[test]
fn few_points_carry_markers() {
    let mass = [0.01, 0.02, 0.05, 0.1, 0.15, 0.2];
    let twice: Vec<f64> = mass.iter().chain(&mass).copied().collect();
    let eta: Vec<f64> =
        twice.iter().enumerate().map(|(i, m)| 1.0 + 13.0 * m - if i < 6 { 0.0 } else { 0.06 }).collect();
    let psi: Vec<f64> = twice.iter().map(|m| 1.0 + 12.2 * m).collect();
    let table = Table::default()
        .with(numbers("mass_ratio", "m′", "", twice.clone()))
        .with(texts("solver", [["event_driven"; 6], ["fixed_step_1e-2s"; 6]].concat()))
        .with(texts("variant", ["baseline"; 12]))
        .with(numbers("displacement_ratio", "η", "", eta))
        .with(numbers("velocity_ratio", "ψ", "", psi));
    let mut experiment = limit_stop();
    experiment.maximise = Some(Maximise {
        measure: Measure::VelocityRatio,
        over: Parameter::ForceRatio,
        grid: Vec::new(),
        refine: 3,
        wanted: SearchPoint::Maximum,
    });
    let spec = figure(vec![Panel {
        by: vec!["solver".into()],
        markers: true,
        ..panel("mass_ratio", AxisScale::Linear, &["velocity_ratio", "displacement_ratio"])
    }]);
    picture(
        "markers",
        &experiment,
        &spec,
        &table,
        &[study("velocity_ratio", "mass_ratio", QuotedAt::Point { x: 0.05, y: 1.516, known: Known::Y })],
    );
}

/// h′ = 10, 50, 90 and infinity against base amplitude.
#[test]
fn an_infinite_gap_is_a_line_of_its_own() {
    let amplitudes = log_range(0.1, 100.0, 80);
    let gaps = [10.0, 50.0, 90.0, f64::INFINITY];
    let rows: Vec<(f64, f64)> = gaps.iter().flat_map(|gap| amplitudes.iter().map(|a| (*gap, *a))).collect();
    let ratio = |(gap, a): &(f64, f64)| {
        if gap.is_finite() { hump(*a, gap / 20.0, 0.5 + gap / 300.0) } else { hump(a.min(20.0), 20.0, 0.9) }
    };
    let table = Table::default()
        .with(numbers("gap_ratio", "h′", "", rows.iter().map(|row| row.0).collect()))
        .with(numbers("base_amplitude_ratio", "aω²/g", "", rows.iter().map(|row| row.1).collect()))
        .with(texts("variant", vec!["baseline"; rows.len()]))
        .with(numbers("displacement_ratio", "η", "", rows.iter().map(ratio).collect()));
    let by = vec!["gap_ratio".into()];
    let spec = figure(vec![Panel { by, ..panel("base_amplitude_ratio", AxisScale::Log, &["displacement_ratio"]) }]);
    picture("gaps", &limit_stop(), &spec, &table, &[]);
}

#[test]
fn infinity_on_the_x_axis_becomes_a_level() {
    let gaps = [5.0, 10.0, 20.0, 50.0, 90.0, 150.0, f64::INFINITY];
    let maxima = gaps.iter().map(|gap| 3.6 - 8.0 / gap).collect();
    let table = Table::default()
        .with(numbers("gap_ratio", "h′", "", gaps.to_vec()))
        .with(texts("variant", ["baseline"; 7]))
        .with(numbers("velocity_ratio", "ψ", "", maxima));
    let spec = figure(vec![Panel { markers: true, ..panel("gap_ratio", AxisScale::Log, &["velocity_ratio"]) }]);
    picture("limit", &limit_stop(), &spec, &table, &[]);
}

/// Ten pulse durations: more lines than named colours, on a logarithmic y axis too.
#[test]
fn many_levels_take_a_ramp_of_colours() {
    let amplitudes = log_range(0.1, 100.0, 40);
    let durations: Vec<f64> = (1..=10).map(|i| 0.01 * f64::from(i)).collect();
    let rows: Vec<(f64, f64)> = durations.iter().flat_map(|d| amplitudes.iter().map(|a| (*d, *a))).collect();
    let table = Table::default()
        .with(numbers("pulse_duration", "", "s", rows.iter().map(|row| row.0).collect()))
        .with(numbers("force_ratio", "f′", "", rows.iter().map(|row| row.1).collect()))
        .with(texts("variant", vec!["baseline"; rows.len()]))
        .with(numbers(
            "velocity_ratio",
            "ψ",
            "",
            rows.iter().map(|(d, a)| hump(*a, 2.0 + 60.0 * d, 2.2 - 15.0 * d)).collect(),
        ));
    let mut one = panel("force_ratio", AxisScale::Log, &[]);
    one.by = vec!["pulse_duration".into()];
    one.y = vec![axis("velocity_ratio", AxisScale::Log)];
    picture("durations", &limit_stop(), &figure(vec![one]), &table, &[]);
}

#[test]
fn a_flat_or_tiny_curve_still_has_an_axis() {
    let table = Table::default()
        .with(numbers("force_ratio", "f′", "", vec![1.0, 2.0, 3.0]))
        .with(texts("variant", ["baseline"; 3]))
        .with(numbers("velocity_ratio", "ψ", "", vec![1.0; 3]))
        .with(numbers("energy_residual", "", "", vec![1.2e-14, 3.1e-14, 2.0e-14]));
    let panels = vec![
        panel("force_ratio", AxisScale::Linear, &["velocity_ratio"]),
        panel("force_ratio", AxisScale::Linear, &["energy_residual"]),
    ];
    picture("flat", &limit_stop(), &figure(panels), &table, &[]);
}

/// Where the motion is another one nothing is known of this one.
#[test]
fn a_line_of_one_kind_of_motion_ends_where_rows_of_another_kind_begin() {
    let kinds = ["periodic", "periodic", "chaotic", "chaotic", "periodic", "periodic"];
    let table = Table::default()
        .with(numbers("force_ratio", "f′", "", (1..=6).map(f64::from).collect()))
        .with(texts("variant", ["baseline"; 6]))
        .with(texts("motion", kinds))
        .with(numbers("velocity_ratio", "ψ", "", vec![1.0, 1.1, 1.5, 1.6, 1.2, 1.3]));
    let by_motion = Panel { by: vec!["motion".into()], ..panel("force_ratio", AxisScale::Linear, &["velocity_ratio"]) };
    let svg = picture("by-motion", &limit_stop(), &figure(vec![by_motion]), &table, &[]).svg;
    let strokes = |name: &str| {
        let group = svg.split(&format!("<g data-name=\"{name}")).nth(1).unwrap().split("</g>").next().unwrap();
        group.matches("<path").count()
    };
    assert_eq!([strokes("periodic"), strokes("chaotic")], [2, 1], "{svg}");
}

#[test]
fn a_figure_that_cannot_be_drawn_says_why() {
    let experiment = limit_stop();
    let table = limit_stop_table();
    let attempt = |panel: Panel| draw(&experiment, &figure(vec![panel]), &table, Beside::default()).unwrap_err();

    let unknown = attempt(panel("force_ratio", AxisScale::Log, &["velocity"]));
    assert!(matches!(&unknown, FigureError::UnknownColumn { column, .. } if column == "velocity"));
    assert!(unknown.to_string().contains("velocity_ratio"), "{unknown} does not tell what there is");
    assert!(matches!(attempt(panel("force_ratio", AxisScale::Log, &["solver"])), FigureError::Text { .. }));

    let nothing = table.select(&[50]);
    let spec = figure(vec![amplitude_panel()]);
    assert!(matches!(draw(&experiment, &spec, &nothing, Beside::default()), Err(FigureError::Nothing { .. })));
    let lists = history();
    let mixed = lists.with(numbers("velocity_ratio", "ψ", "", vec![1.0]));
    let spec = figure(vec![panel("time", AxisScale::Linear, &["velocity_ratio"])]);
    assert!(matches!(draw(&experiment, &spec, &mixed, Beside::default()), Err(FigureError::Mixed { .. })));
}

#[test]
fn measures_that_agree_can_both_be_seen() {
    let amplitudes = log_range(0.1, 100.0, 61);
    let twice: Vec<f64> = amplitudes.iter().chain(&amplitudes).copied().collect();
    let ratio: Vec<f64> = twice.iter().map(|a| hump(*a, 2.5, 0.6)).collect();
    // The fixed step stands first in the table, and yet the exact motion is drawn solid.
    let solvers = [["fixed_step_1e-5s"; 61], ["event_driven"; 61]].concat();
    let table = Table::default()
        .with(numbers("base_amplitude_ratio", "aω²/g", "", twice))
        .with(texts("solver", solvers))
        .with(texts("variant", ["baseline"; 122]))
        .with(numbers("displacement_ratio", "η", "", ratio.clone()))
        .with(numbers("velocity_ratio", "ψ", "", ratio));
    let mut one = panel("base_amplitude_ratio", AxisScale::Log, &["displacement_ratio", "velocity_ratio"]);
    one.by = vec!["solver".into()];
    picture("agreeing", &limit_stop(), &figure(vec![one]), &table, &[]);
}

/// Two resonances of a clean beam and of one with a damper, with the peaks at 1/k of them that impulses add.
#[test]
fn a_strip_below_the_frame_says_which_motion_each_point_belongs_to() {
    let kinds =
        ["at rest", "periodic 1:1", "periodic 1:2", "periodic 1:2", "chaotic", "", "not settled", "sticking 2:2"];
    let count = kinds.len();
    let x: Vec<f64> = (0..count).map(|i| 1.0 + i as f64).collect();
    let columns = vec![
        Column::new("variant", Data::Text(vec!["baseline".into(); count])),
        Column::new("force_ratio", Data::Float(x.clone())),
        Column::new("velocity_ratio", Data::Float(x.iter().map(|x| 1.0 / x).collect())),
        Column::new("motion", Data::Text(kinds.map(String::from).into())),
    ];
    let table = Table { columns, ..Table::default() };
    let plain = panel("force_ratio", AxisScale::Linear, &["velocity_ratio"]);
    let svg = |strip: Option<Strip>| {
        picture("strip", &limit_stop(), &figure(vec![Panel { strip, ..plain.clone() }]), &table, &[]).svg
    };
    assert!(!svg(None).contains("data-note"));
    let drawn = svg(Some(Strip::Motion));
    // Neighbours of one kind are one cell; a row without a motion has none; a legend names the classes that are there.
    let notes: Vec<&str> = drawn.split("data-note=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert_eq!(notes, ["at rest", "periodic 1:1", "periodic 1:2", "chaotic", "not settled", "sticking 2:2"]);
    for named in ["at rest", "periodic 1:1", "other periodic", "chaotic", "not settled"] {
        assert!(drawn.contains(&format!(">{named}<")), "{named}: {drawn}");
    }
    assert!(!drawn.contains(">quasi-periodic<"));
    // The colours are the strip's alone, and the legend says so.
    assert!(drawn.contains(">motion:<"), "{drawn}");
    let filled = |rest: &str| rest.split_once("fill=\"").map(|(_, fill)| fill[..7].to_owned());
    let cells: BTreeSet<String> = drawn.split("data-note=\"").skip(1).filter_map(filled).collect();
    assert_eq!(cells.len(), 5, "{cells:?}");
    for line in ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"] {
        assert!(!cells.contains(line), "{line} is a line's");
    }
}

/// The texts of a drawing that are numbers, as a reader sees them.
fn numbers_in(svg: &str) -> Vec<f64> {
    lines_of_text(svg).iter().filter_map(|(text, _)| text.replace('−', "-").parse().ok()).collect()
}

#[test]
fn a_logarithmic_axis_has_three_numbers_at_least() {
    let drawn = |from: f64, to: f64, unit: &str| {
        let gaps = log_range(from, to, 20);
        let ratios = gaps.iter().map(|gap| gap / from - 1.0).collect();
        let table = Table::default()
            .with(numbers("gap", "h", unit, gaps))
            .with(texts("variant", ["baseline"; 20]))
            .with(numbers("velocity_ratio", "ψ", "", ratios));
        let mut one = panel("gap", AxisScale::Log, &["velocity_ratio"]);
        one.y[0].label = Some("ratio".into());
        let svg = picture("short-log", &limit_stop(), &figure(vec![one]), &table, &[]).svg;
        // Those of the y axis begin at 0 and stand at the end.
        let numbers = numbers_in(&svg);
        let y = numbers.iter().rposition(|number| *number == 0.0).unwrap();
        (numbers[..y].to_vec(), svg)
    };
    assert_eq!(drawn(2.5, 3.6, "").0, [2.6, 2.8, 3.0, 3.2, 3.4, 3.6]);
    assert_eq!(drawn(1.5, 6.0, "").0, [2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(drawn(1e-4, 8e-3, "m").0, [0.1, 0.2, 0.5, 1.0, 2.0, 5.0]);
    let (numbers, svg) = drawn(1e-4, 8.37e-2, "m");
    assert_eq!(numbers, [0.1, 1.0, 10.0]);
    assert!(svg.contains(">Gap clearance h (mm)<"), "{svg}");
    // Where a plain number is longer than its power of ten, within a decade.
    let (_, svg) = drawn(2e-7, 9e-7, "");
    let labels: Vec<String> = lines_of_text(&svg).into_iter().map(|(text, _)| text).collect();
    assert!(["2·10⁻⁷", "5·10⁻⁷", "9·10⁻⁷"].iter().all(|label| labels.iter().any(|one| one == label)), "{labels:?}");
}

/// The resonance of [`a_part_of_the_axis_is_a_panel_of_its_own`].
fn resonance() -> Table {
    let frequencies: Vec<f64> = (0..121).map(|i| 2.0 * std::f64::consts::PI * (10.0 + 0.5 * f64::from(i))).collect();
    let ratios = frequencies.iter().map(|w| 1.0 + 5.0 / (1.0 + (w / 6.0 - 31.4).powi(2))).collect();
    Table::default()
        .with(numbers("angular_frequency", "ω", "rad/s", frequencies))
        .with(texts("variant", ["baseline"; 121]))
        .with(numbers("velocity_ratio", "ψ", "", ratios))
}

#[test]
fn numbers_stand_in_the_unit_that_an_axis_names() {
    let mut one = panel("angular_frequency", AxisScale::Linear, &["velocity_ratio"]);
    one.x.unit = Some(AxisUnit { symbol: "Hz".into(), worth: std::f64::consts::TAU });
    // In cycles a second an angular frequency is called by what it is there.
    let svg = picture("hertz-by-symbol", &limit_stop(), &figure(vec![one.clone()]), &resonance(), &[]).svg;
    assert!(svg.contains(">Frequency ω/2π (Hz)<"), "{svg}");
    one.x.label = Some("frequency".into());
    let svg = picture("hertz", &limit_stop(), &figure(vec![one]), &resonance(), &[]).svg;
    assert!(svg.contains(">Frequency (Hz)<"), "{svg}");
    assert!([10.0, 40.0, 70.0].iter().all(|frequency| numbers_in(&svg).contains(frequency)), "{svg}");
}

#[test]
fn a_part_of_the_axis_is_a_panel_of_its_own() {
    let whole = panel("angular_frequency", AxisScale::Linear, &["velocity_ratio"]);
    let mut part = whole.clone();
    part.x.range = Some([170.0, 205.0]);
    let at = |x: f64, y: f64| study("velocity_ratio", "angular_frequency", QuotedAt::Point { x, y, known: Known::Y });
    let quoted = [
        Quoted { label: "within".into(), ..at(188.0, 5.8) },
        Quoted { label: "outside".into(), ..at(300.0, 1.1) },
        Quoted { label: "of all".into(), at: QuotedAt::Level(1.4), ..at(0.0, 0.0) },
    ];
    let svg = picture("part", &limit_stop(), &figure(vec![whole, part]), &resonance(), &quoted).svg;
    // Each number is named where it is seen best, and each panel has an axis of its own.
    for label in ["within", "outside", "of all"] {
        assert_eq!(svg.matches(&format!(">{label}<")).count(), 1, "{label}");
    }
    assert_eq!(svg.matches(">Angular frequency ω (rad/s)<").count(), 2);
    assert!([100.0, 175.0, 200.0].iter().all(|frequency| numbers_in(&svg).contains(frequency)), "{svg}");
    // The line runs to both edges of the part.
    let part = svg.split("data-frame=").nth(2).unwrap();
    assert!(part.contains("data-x=\"linear 170 205\""), "{part}");
}

#[test]
fn peaks_of_a_frequency_response_carry_their_places() {
    let frequencies: Vec<f64> = (0..351).map(|i| 5.0 + 0.5 * f64::from(i)).collect();
    let response = |resonances: [f64; 2], w: f64| {
        let one = |w0: f64, height: f64| height / ((1.0 - (w / w0).powi(2)).powi(2) + (0.02 * w / w0).powi(2)).sqrt();
        (1..=4).map(|k| one(resonances[0] / f64::from(k), 4e-3 / f64::from(k * k * k))).sum::<f64>()
            + one(resonances[1], 2e-4)
    };
    let rows = [("clean", [26.1, 163.7]), ("damper", [22.0, 149.3])];
    let heights =
        rows.iter().flat_map(|(_, resonances)| frequencies.iter().map(|w| response(*resonances, *w))).collect();
    let table = Table::default()
        .with(texts("sweep", [["clean"; 351], ["damper"; 351]].concat()))
        .with(numbers("angular_frequency", "ω", "rad/s", frequencies.repeat(2)))
        .with(texts("variant", ["baseline"; 702]))
        .with(numbers("displacement_per_impulse", "", "m/(N s)", heights));
    let mut one = panel("angular_frequency", AxisScale::Linear, &[]);
    one.by = vec!["sweep".into()];
    one.y = vec![axis("displacement_per_impulse", AxisScale::Log)];
    one.peaks = Some(PeakMarks { prominence: 0.03, most: 6 });
    picture("peaks", &limit_stop(), &figure(vec![one]), &table, &[]);
}

/// Lists a row: a measure of every cycle, for three plates.
#[test]
fn a_measure_of_every_cycle_is_a_curve() {
    let cycles: Vec<f64> = (0..125).map(f64::from).collect();
    let measure = |level: f64| cycles.iter().map(|n| level * (1.0 - 0.8 * (-n / 12.0).exp())).collect::<Vec<f64>>();
    let lists = |name: &str, cells: Vec<Vec<f64>>| Column::new(name, Data::FloatList(cells));
    let mut mass = vec![measure(1.0), measure(0.7), measure(0.2)];
    mass[1][0] = f64::NAN;
    let table = Table::default()
        .with(texts("sweep", ["clean", "light", "heavy"]))
        .with(texts("variant", ["baseline"; 3]))
        .with(lists("cycle", vec![cycles.clone(); 3]))
        .with(lists("damping_measure_of_cycle", vec![measure(0.06), measure(0.2), measure(0.45)]))
        .with(lists("mass_measure_of_cycle", mass));
    let by = || vec!["sweep".into()];
    let panels = ["damping_measure_of_cycle", "mass_measure_of_cycle"]
        .map(|column| Panel { by: by(), ..panel("cycle", AxisScale::Linear, &[column]) });
    picture("cycles", &limit_stop(), &figure(panels.into()), &table, &[]);
}

/// Shapes of a beam, lists a row, with the line at which they do not move.
#[test]
fn shapes_of_a_beam_are_curves_along_it() {
    let x: Vec<f64> = (0..101).map(|i| f64::from(i) / 100.0).collect();
    let shape = |n: f64| x.iter().map(|x| (n * 4.7 * x).sin() * (1.0 - (-4.0 * x).exp())).collect::<Vec<f64>>();
    let lists = |name: &str, cells: Vec<Vec<f64>>| Column::new(name, Data::FloatList(cells));
    let table = Table::default()
        .with(numbers("mode", "", "", vec![1.0, 2.0, 3.0, 4.0]))
        .with(texts("variant", ["baseline"; 4]))
        .with(lists("x", vec![x.clone(); 4]))
        .with(lists("shape", [0.4, 1.0, 1.7, 2.4].map(shape).into()));
    let guides = vec![Level { at: 0.0, label: String::new() }];
    let mut one = Panel { by: vec!["mode".into()], guides, ..panel("x", AxisScale::Linear, &["shape"]) };
    one.x.label = Some("x/L".into());
    one.y[0].label = Some("deflection, largest 1".into());
    picture("shapes", &limit_stop(), &figure(vec![one]), &table, &[]);
}
