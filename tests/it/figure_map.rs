//! Maps: a quantity over two others, as colours. Each test leaves its picture in `target/tmp`, to be looked at.

use shotdamp::experiment::{AxisScale, Best, Drawing, MapSpec, Mark};
use shotdamp::figure::{Beside, FigureError, Picture, draw};
use shotdamp::table::{Column, Data, Table};

use crate::made_up::{axis, drawn, limit_stop, log_range, numbers};

fn map(x: &str, y: &str, value: &str) -> MapSpec {
    let axis = |name| axis(name, AxisScale::Linear);
    MapSpec {
        x: axis(x),
        y: axis(y),
        value: axis(value),
        by: Vec::new(),
        mark: None,
        best: Best::Highest,
        centre: None,
        aspect: None,
        columns: None,
    }
}

fn picture(name: &str, spec: MapSpec, table: &Table) -> Vec<u8> {
    let Picture { svg, png } =
        draw(&limit_stop(), &drawn(Drawing::Map(spec.into())), table, Beside::default()).unwrap();
    assert!(svg.len() < 250_000, "{name}: {} bytes of SVG are too many to commit", svg.len());
    std::fs::write(format!("{}/{name}.png", env!("CARGO_TARGET_TMPDIR")), &png).unwrap();
    assert!(png.len() < 250_000, "{name}: {} bytes are too many to commit", png.len());
    png
}

fn words(name: &str, cells: Vec<String>) -> Column {
    Column::new(name, Data::Text(cells))
}

fn baseline(table: Table) -> Table {
    let rows = table.rows();
    table.with(words("variant", vec!["baseline".into(); rows]))
}

fn steps(from: f64, to: f64, count: u32) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * f64::from(i) / f64::from(count - 1)).collect()
}

/// 49 places of a damper on a plate for each of six places of the force.
fn plate() -> Table {
    let forces = [(0.25, 0.125), (0.125, 0.375), (0.25, 0.25), (0.25, 0.375), (0.375, 0.5), (0.5, 0.5)];
    let (mut sweep, mut columns) = (Vec::new(), [const { Vec::new() }; 5]);
    for (index, (fx, fy)) in forces.iter().enumerate() {
        for y in steps(0.125, 0.875, 7) {
            for x in steps(0.125, 0.875, 7) {
                let mode = |x: f64, y: f64| (std::f64::consts::PI * x).sin() * (std::f64::consts::PI * y).sin();
                let near = (-30.0 * ((x - fx).powi(2) + (y - fy).powi(2))).exp();
                let value = 1.0 + 1.4 * mode(*fx, *fy) * (mode(x, y) + if index < 4 { 0.8 * near } else { 0.0 });
                sweep.push(format!("point_{}", index + 1));
                for (column, number) in columns.iter_mut().zip([x, y, *fx, *fy, value]) {
                    column.push(number);
                }
            }
        }
    }
    let [x, y, fx, fy, value] = columns;
    let table = Table::default()
        .with(words("sweep", sweep))
        .with(numbers("damper_x", "", "", x))
        .with(numbers("damper_y", "", "", y))
        .with(numbers("force_x", "", "", fx))
        .with(numbers("force_y", "", "", fy))
        .with(numbers("velocity_ratio", "ψ", "", value));
    baseline(table)
}

fn force() -> Option<Mark> {
    Some(Mark { x: "force_x".into(), y: "force_y".into(), label: "force".into() })
}

#[test]
fn six_places_of_the_force_share_one_scale_of_colours() {
    let mut spec = MapSpec { by: vec!["sweep".into()], mark: force(), ..map("damper_x", "damper_y", "velocity_ratio") };
    spec.aspect = Some(4.0 / 3.0);
    spec.x.reach = Some([0.0, 1.0]);
    spec.y.reach = Some([0.0, 1.0]);
    spec.x.label = Some("damper location x/Lx".into());
    spec.y.label = Some("damper location y/Ly".into());
    picture("map-plate", spec, &plate());
}

#[test]
fn a_map_of_ensembles_says_how_far_they_spread() {
    let spread = |share: f64| {
        let spreads = plate().floats("velocity_ratio").unwrap().iter().map(|ratio| share * ratio).collect();
        plate().with(numbers("velocity_ratio_spread", "", "", spreads))
    };
    let spec = MapSpec { by: vec!["sweep".into()], ..map("damper_x", "damper_y", "velocity_ratio") };
    let svg = |table: &Table| {
        draw(&limit_stop(), &drawn(Drawing::Map(Box::new(spec.clone()))), table, Beside::default()).unwrap().svg
    };
    assert!(svg(&spread(0.013)).contains(", s.d. at most 1.3 %"));
    assert!(!svg(&spread(0.0)).contains("s.d.") && !svg(&plate()).contains("s.d."));
}

#[test]
fn one_map_names_its_best_place() {
    let places = steps(0.1, 1.0, 10);
    let rows: Vec<(f64, f64)> = places.iter().flat_map(|y| places.iter().map(|x| (*x, *y))).collect();
    let table = Table::default()
        .with(numbers("damper_x", "", "", rows.iter().map(|row| row.0).collect()))
        .with(numbers("force_x", "", "", rows.iter().map(|row| row.1).collect()))
        .with(numbers("velocity_ratio", "ψ", "", rows.iter().map(|(x, y)| 1.0 + 4.3 * x * x * y).collect()));
    let mut spec = map("damper_x", "force_x", "velocity_ratio");
    spec.x.label = Some("damper location x/L".into());
    spec.y.label = Some("excitation location x/L".into());
    picture("map-beam", spec, &baseline(table));
}

#[test]
fn cells_without_a_value_are_seen_and_a_centre_parts_the_colours() {
    let (forces, gaps) = (log_range(0.1, 100.0, 25), log_range(5.0, 200.0, 13));
    let rows: Vec<(f64, f64)> = gaps.iter().flat_map(|gap| forces.iter().map(|f| (*f, *gap))).collect();
    let ratio = |(i, (f, gap)): (usize, &(f64, f64))| {
        if i % 37 == 5 { f64::NAN } else { 1.0 + 0.7 * (f / gap * 20.0).ln().sin() / (1.0 + 0.1 * f) }
    };
    let table = Table::default()
        .with(numbers("force_ratio", "f′", "", rows.iter().map(|row| row.0).collect()))
        .with(numbers("gap_ratio", "h′", "", rows.iter().map(|row| row.1).collect()))
        .with(numbers("velocity_ratio", "ψ", "", rows.iter().enumerate().map(ratio).collect()));
    let mut spec =
        MapSpec { centre: Some(1.0), aspect: Some(0.7), ..map("force_ratio", "gap_ratio", "velocity_ratio") };
    spec.x.scale = AxisScale::Log;
    spec.y.scale = AxisScale::Log;
    picture("map-centre", spec, &baseline(table));
}

/// Four modes of a plate over a grid of 41 x 41 points, lists a row.
fn modes() -> Table {
    let grid = steps(0.0, 1.0, 41);
    let spots: Vec<(f64, f64)> = grid.iter().flat_map(|y| grid.iter().map(|x| (*x, *y))).collect();
    let orders = [(1.0, 1.0), (1.0, 2.0), (2.0, 1.0), (1.0, 3.0)];
    let shape = |(m, n): &(f64, f64)| {
        let sine = |order: f64, x: f64| (order * std::f64::consts::PI * x).sin();
        spots.iter().map(|(x, y)| sine(*m, *x) * sine(*n, *y)).collect()
    };
    let lists = |name: &str, cells: Vec<Vec<f64>>| Column::new(name, Data::FloatList(cells));
    let table = Table::default()
        .with(numbers("mode", "", "", vec![1.0, 2.0, 3.0, 4.0]))
        .with(numbers("natural_frequency", "ω", "rad/s", vec![188.5, 391.8, 551.1, 728.6]))
        .with(lists("x", vec![spots.iter().map(|spot| spot.0).collect(); 4]))
        .with(lists("y", vec![spots.iter().map(|spot| spot.1).collect(); 4]))
        .with(lists("shape", orders.iter().map(shape).collect()));
    baseline(table)
}

#[test]
fn shapes_of_a_plate_show_their_nodal_lines() {
    let by = vec!["mode".into(), "natural_frequency".into()];
    let mut spec = MapSpec { by, best: Best::None, centre: Some(0.0), ..map("x", "y", "shape") };
    spec.aspect = Some(4.0 / 3.0);
    spec.value.label = Some("deflection, largest 1".into());
    spec.x.label = Some("x/Lx".into());
    spec.y.label = Some("y/Ly".into());
    picture("map-modes", spec.clone(), &modes());
    assert_eq!(picture("map-modes", spec.clone(), &modes()), picture("map-modes", spec, &modes()));
}

/// Numbers for programs are written in the fewest letters.
#[test]
fn tiny_numbers_behind_a_map_are_short() {
    let tiny = plate().floats("velocity_ratio").unwrap().iter().map(|ratio| 9.608_123e-18 * ratio).collect();
    let table = plate().with(numbers("map", "", "", tiny));
    let spec = MapSpec { by: vec!["sweep".into()], ..map("damper_x", "damper_y", "map") };
    let svg = draw(&limit_stop(), &drawn(Drawing::Map(spec.into())), &table, Beside::default()).unwrap().svg;
    let values = svg.split("data-values=\"").nth(1).unwrap().split('"').next().unwrap();
    assert!(values.split(' ').all(|value| value.len() <= 9 && value.parse::<f64>().is_ok()), "{values}");
}

#[test]
fn a_map_that_cannot_be_drawn_says_why() {
    let attempt = |spec: MapSpec, table: &Table| {
        draw(&limit_stop(), &drawn(Drawing::Map(spec.into())), table, Beside::default()).unwrap_err()
    };
    let plate = plate();
    let overlaid = attempt(map("damper_x", "damper_y", "velocity_ratio"), &plate);
    assert!(matches!(overlaid, FigureError::Twice { .. }) && overlaid.to_string().contains("`by`"), "{overlaid}");
    let several = attempt(map("x", "y", "shape"), &modes());
    assert!(matches!(several, FigureError::ManyFields { rows: 4, .. }), "{several}");
    let unknown = attempt(map("damper_x", "damper_z", "velocity_ratio"), &plate);
    assert!(matches!(unknown, FigureError::UnknownColumn { .. }), "{unknown}");
    let mixed = attempt(map("mode", "y", "shape"), &modes());
    assert!(matches!(mixed, FigureError::Mixed { .. }), "{mixed}");
    let words = attempt(map("damper_x", "damper_y", "sweep"), &plate);
    assert!(matches!(words, FigureError::Text { .. }), "{words}");
    let nothing = attempt(map("damper_x", "damper_y", "velocity_ratio"), &plate.select(&[]));
    assert!(matches!(nothing, FigureError::Nothing { .. }), "{nothing}");
}
