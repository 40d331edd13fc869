//! The scene as a drawing: what vibrates, the dampers on it, where it is forced and observed.
//!
//! A single mass is drawn as its mechanical model, a beam or plate from above to scale with the node lines of the mode that is
//! forced. Several scenes of one experiment are one drawing, with all places that they use.

use super::canvas::{Anchor, Lettering, Pen, Sheet, svg, text_width, wrapped};
use super::contour::contours;
use super::field::{Field, Spot};
use super::geometry::{Point as At, Rect};
use super::glyph::{arrow, dashpot, hatch, spring};
use super::style::{BLUE_INK, CURVE, Color, GREY, INK, NOTE_TEXT, PALE, PAPER, PLACE, SKETCH_WIDTH, SPACE, VERMILION};
use crate::scene::{Damper, Excitation, Model, Point, Scene, Structure, Surface};
use crate::text::number::quantity;

/// Nodes along a side, for node lines.
const NODES: u32 = 48;

/// True if there is something to draw: a single mass, or a structure with sides.
#[must_use]
pub fn is_sketched(scenes: &[Scene]) -> bool {
    let drawn = |scene: &Scene| {
        matches!(scene.structure, Structure::SingleMass(_)) || !scene.structure.model().sides().is_empty()
    };
    scenes.first().is_some_and(drawn)
}

/// The SVG of the scenes of an experiment; `None` without any.
#[must_use]
pub fn sketch(scenes: &[Scene]) -> Option<String> {
    let first = scenes.first()?;
    let sides = first.structure.model().sides();
    // A place on a plate of another size would be elsewhere.
    let alike: Vec<Scene> = scenes.iter().filter(|scene| scene.structure.model().sides() == sides).cloned().collect();
    let scenes = alike.as_slice();
    Some(match (&first.structure, sides.as_slice()) {
        (Structure::SingleMass(_), _) => svg(SKETCH_WIDTH, 620.0, |sheet| mass(sheet, first)),
        (_, [length]) => svg(SKETCH_WIDTH, 330.0, |sheet| beam(sheet, scenes, *length)),
        (_, [wide, long, ..]) => {
            let width = 560.0;
            let high = width * long / wide;
            svg(SKETCH_WIDTH, high + 5.0 * SPACE, |sheet| plate(sheet, scenes, [*wide, *long], width))
        }
        _ => return None,
    })
}

/// Places used by some scene, each once.
fn places(scenes: &[Scene], of: impl Fn(&Scene) -> Vec<Point>) -> Vec<Point> {
    let mut found: Vec<Point> = Vec::new();
    for place in scenes.iter().flat_map(of) {
        if !found.contains(&place) {
            found.push(place);
        }
    }
    found
}

fn dampers(scene: &Scene) -> Vec<Point> {
    scene.dampers.iter().map(|damper| damper.at).collect()
}

/// Where forces act that move the structure.
fn forces(scene: &Scene) -> Vec<Point> {
    let moves = scene.structure.model().shape(scene.force_at).iter().any(|share| share.abs() > 1e-9);
    if moves { vec![scene.force_at] } else { Vec::new() }
}

/// Half the size of a damper's sign, so that neighbours do not cover each other where they need not.
fn half_size(places: &[At]) -> f64 {
    let pairs = places.iter().enumerate().flat_map(|(index, a)| places[..index].iter().map(move |b| (a, b)));
    let apart = pairs.map(|(a, b)| (a.x - b.x).abs().max((a.y - b.y).abs())).fold(f64::INFINITY, f64::min);
    (0.42 * apart).clamp(6.0, 15.0)
}

/// What a drawing shows, for its legend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sign {
    Damper,
    Force,
    Observed,
    /// Of the forced mode, by its number.
    NodeLine(usize),
}

/// The mode whose natural frequency is nearest to the forcing frequency, from 1.
fn forced_mode(scene: &Scene) -> Option<usize> {
    let forced = match scene.excitation {
        Excitation::Harmonic { angular_frequency, .. } => angular_frequency,
        Excitation::ImpulseTrain { period, .. } | Excitation::PulseTrain { period, .. } => {
            std::f64::consts::TAU / period
        }
        Excitation::SingleImpulse { .. } => return None,
    };
    let frequencies = scene.structure.model().natural_frequencies();
    let distance = |at: &usize| (frequencies[*at] - forced).abs();
    (0..frequencies.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).map(|at| at + 1)
}

/// Displacement at a point in a mode.
fn deflection(model: &dyn Model, mode: &[f64], at: Point) -> f64 {
    model.shape(at).iter().zip(mode).map(|(shape, q)| shape * q).sum()
}

fn beam(sheet: &Sheet, scenes: &[Scene], length: f64) {
    let (left, right, y) = (90.0, SKETCH_WIDTH - 90.0, 150.0);
    let at = |x: f64| left + x / length * (right - left);
    let scene = &scenes[0];
    hatch(sheet, &Rect { left: left - 26.0, top: y - 60.0, right: left, bottom: y + 60.0 });
    if matches!(scene.structure, Structure::ClampedBeam(_)) {
        hatch(sheet, &Rect { left: right, top: y - 60.0, right: right + 26.0, bottom: y + 60.0 });
    }
    sheet.cell(&Rect { left, top: y - 7.0, right, bottom: y + 7.0 }, INK);
    let mut signs = Vec::new();
    let feet: Vec<At> = places(scenes, dampers).iter().map(|place| At { x: at(place.x), y: y - 7.0 }).collect();
    let half = half_size(&feet);
    for foot in &feet {
        damper_box(sheet, *foot, half);
    }
    signs.extend((!feet.is_empty()).then_some(Sign::Damper));
    let forces = places(scenes, forces);
    signs.extend((!forces.is_empty()).then_some(Sign::Force));
    signs.push(Sign::Observed);
    for place in forces {
        let tip = At { x: at(place.x), y: y + 9.0 };
        arrow(sheet, At { y: tip.y + 54.0, ..tip }, tip, VERMILION);
    }
    for place in places(scenes, |scene| scene.observed.points.clone()) {
        sheet.ring(At { x: at(place.x), y }, 15.0, Pen::solid(BLUE_INK, CURVE * 0.8));
    }
    if let Some(number) = forced_mode(scene) {
        let (model, mut before) = (scene.structure.model(), 0.0);
        let mode = model.mode(number);
        let mut nodes = 0;
        for node in 1..=10 * NODES {
            let x = f64::from(node) / f64::from(10 * NODES) * length;
            let here = deflection(model, &mode, Point { x, y: 0.0 });
            if before * here < 0.0 {
                let ends = [At { x: at(x), y: y - 46.0 }, At { x: at(x), y: y + 46.0 }];
                sheet.line(&ends, Pen { color: GREY, width: 3.0, dash: &[8.0, 6.0] });
                nodes += 1;
            }
            before = here;
        }
        signs.extend((nodes > 0).then_some(Sign::NodeLine(number)));
    }
    for (share, text) in [(0.0, "0".to_owned()), (1.0, quantity(length, "m", 3))] {
        write(sheet, At { x: left + share * (right - left), y: y + 92.0 }, &text, Anchor::Centre, INK);
    }
    legend(sheet, At { x: left, y: y + 150.0 }, &signs, false);
}

fn plate(sheet: &Sheet, scenes: &[Scene], [wide, long]: [f64; 2], width: f64) {
    let frame = Rect { left: 70.0, top: 2.0 * SPACE, right: 70.0 + width, bottom: 2.0 * SPACE + width * long / wide };
    let at = |place: Point| frame.at(place.x / wide, place.y / long);
    sheet.cell(&frame, PALE);
    let scene = &scenes[0];
    let mut node_line = None;
    if let Some(number) = forced_mode(scene) {
        let model = scene.structure.model();
        let mode = model.mode(number);
        let along = |node: u32| f64::from(node) / f64::from(NODES);
        let spots: Vec<Spot> = (1..NODES)
            .flat_map(|i| (1..NODES).map(move |j| (along(i), along(j))))
            .map(|(x, y)| Spot { x, y, value: deflection(model, &mode, Point { x: x * wide, y: y * long }) })
            .collect();
        if let Ok(field) = Field::of(&spots) {
            let lines = contours(&field, Some, 0.0);
            node_line = (!lines.is_empty()).then_some(Sign::NodeLine(number));
            for line in lines {
                let place = |node: &super::contour::Node| {
                    frame.at((node.column + 1.0) / f64::from(NODES), (node.row + 1.0) / f64::from(NODES))
                };
                let points: Vec<At> = line.iter().map(place).collect();
                sheet.line(&points, Pen { color: GREY, width: 3.0, dash: &[8.0, 6.0] });
            }
        }
    }
    let corners = frame.corners();
    let edge = [corners[0], corners[1], corners[2], corners[3], corners[0], corners[1]];
    sheet.line(&edge, Pen::solid(INK, CURVE));
    let boxes: Vec<At> = places(scenes, dampers).into_iter().map(at).collect();
    let square = half_size(&boxes);
    for &at in &boxes {
        let place = Rect { left: at.x, top: at.y, right: at.x, bottom: at.y };
        sheet.cell(&place.grown(square), INK);
        sheet.cell(&place.grown(0.73 * square), PAPER);
        sheet.disc(at, 0.4 * square, INK);
    }
    for place in places(scenes, |scene| scene.observed.points.clone()) {
        sheet.ring(at(place), 21.0, Pen::solid(BLUE_INK, CURVE * 0.8));
    }
    let forces = places(scenes, forces);
    let signs = [
        (!boxes.is_empty()).then_some(Sign::Damper),
        (!forces.is_empty()).then_some(Sign::Force),
        Some(Sign::Observed),
        node_line,
    ];
    for place in forces {
        let at = at(place);
        for sign in [-1.0, 1.0] {
            let ends = [-13.0, 13.0].map(|by| At { x: at.x + by, y: at.y + sign * by });
            sheet.line(&ends, Pen::solid(VERMILION, 1.4 * CURVE));
        }
    }
    let (x, y) = (frame.right + 60.0, frame.top + 40.0);
    let signs: Vec<Sign> = signs.into_iter().flatten().collect();
    let end = legend(sheet, At { x, y }, &signs, true);
    let size = format!("{} by {}, simply supported", quantity(wide, "m", 3), quantity(long, "m", 3));
    for (row, line) in wrapped(&size, NOTE_TEXT, SKETCH_WIDTH - x - SPACE).iter().enumerate() {
        write(sheet, At { x, y: end.y + 12.0 + 46.0 * row as f64 }, line, Anchor::Left, INK);
    }
}

/// What the signs stand for, in a row or in a column; returns where the next would stand.
fn legend(sheet: &Sheet, start: At, signs: &[Sign], column: bool) -> At {
    let mut at = start;
    for sign in signs {
        let centre = At { x: at.x + 16.0, ..at };
        let word = match sign {
            Sign::Damper => "damper".to_owned(),
            Sign::Force => "force".to_owned(),
            Sign::Observed => "observed".to_owned(),
            Sign::NodeLine(mode) => format!("node line, mode {mode}"),
        };
        match sign {
            Sign::Damper => {
                let place = Rect { left: centre.x, top: centre.y, right: centre.x, bottom: centre.y };
                sheet.cell(&place.grown(13.0), INK);
                sheet.cell(&place.grown(9.0), PAPER);
                sheet.disc(centre, 5.0, INK);
            }
            Sign::Force if column => {
                for sign in [-1.0, 1.0] {
                    let ends = [-11.0, 11.0].map(|by| At { x: centre.x + by, y: centre.y + sign * by });
                    sheet.line(&ends, Pen::solid(VERMILION, 1.4 * CURVE));
                }
            }
            Sign::Force => {
                arrow(sheet, At { y: centre.y + 16.0, ..centre }, At { y: centre.y - 16.0, ..centre }, VERMILION)
            }
            Sign::Observed => sheet.ring(centre, 14.0, Pen::solid(BLUE_INK, CURVE * 0.8)),
            Sign::NodeLine(_) => {
                let ends = [At { y: centre.y - 18.0, ..centre }, At { y: centre.y + 18.0, ..centre }];
                sheet.line(&ends, Pen { color: GREY, width: 3.0, dash: &[8.0, 6.0] });
            }
        }
        write(sheet, At { x: at.x + 42.0, ..at }, &word, Anchor::Left, INK);
        if column {
            at.y += 52.0;
        } else {
            at.x += 42.0 + text_width(&word, NOTE_TEXT) + 3.0 * SPACE;
        }
    }
    at
}

/// A damper on a beam: a box with its particle.
fn damper_box(sheet: &Sheet, foot: At, half: f64) {
    let place = Rect { left: foot.x - half, top: foot.y - 46.0, right: foot.x + half, bottom: foot.y };
    sheet.cell(&place, INK);
    sheet.cell(&place.grown(-0.27 * half), PAPER);
    sheet.disc(At { x: foot.x, y: foot.y - 13.0 }, 0.53 * half, INK);
}

/// One mass on its spring and dashpot, with the first damper in it.
fn mass(sheet: &Sheet, scene: &Scene) {
    let Structure::SingleMass(mass) = &scene.structure else { return };
    let ground = Rect { left: 120.0, top: 570.0, right: 560.0, bottom: 596.0 };
    let base = Rect { left: 140.0, top: 90.0, right: 540.0, bottom: 430.0 };
    hatch(sheet, &ground);
    spring(sheet, At { x: 230.0, y: base.bottom }, At { x: 230.0, y: ground.top });
    dashpot(sheet, At { x: 430.0, y: base.bottom }, At { x: 430.0, y: ground.top });
    write(sheet, At { x: 202.0, y: 502.0 }, &quantity(mass.stiffness, "N/m", 3), Anchor::Right, INK);
    write(sheet, At { x: 470.0, y: 502.0 }, &quantity(mass.damping, "N s/m", 3), Anchor::Left, INK);
    sheet.cell(&base, Color(0xD5, 0xDD, 0xE6));
    let corners = base.corners();
    sheet.line(&[corners[0], corners[1], corners[2], corners[3], corners[0], corners[1]], Pen::solid(INK, CURVE));
    let mut notes = vec![format!("base {}", quantity(mass.mass, "kg", 3))];
    if let Some(damper) = scene.dampers.first() {
        enclosure(sheet, damper);
        notes.push(format!("particle {}", quantity(damper.particle_mass, "kg", 3)));
        notes.push(if damper.gap.is_finite() {
            format!("gap h = {}", quantity(damper.gap, "m", 3))
        } else {
            "no ceiling".into()
        });
        notes.push(format!("floor {}", face(&damper.floor)));
        if damper.gap.is_finite() {
            notes.push(format!("ceiling {}", face(&damper.ceiling)));
        }
        if let Some(stop) = damper.stop {
            notes.push(format!("limit stop after {}", quantity(stop.length, "m", 3)));
        }
        if let Some(walls) = damper.walls {
            notes.push(format!("soft walls {}", quantity(walls.stiffness, "N/m", 3)));
        }
    }
    arrow(sheet, At { x: 340.0, y: base.top - 2.0 }, At { x: 340.0, y: 16.0 }, VERMILION);
    let drive = match &scene.excitation {
        Excitation::SingleImpulse { impulse, .. } => format!("one impulse, {}", quantity(*impulse, "N s", 3)),
        Excitation::ImpulseTrain { impulse, period } => {
            format!("impulses of {} every {}", quantity(*impulse, "N s", 3), quantity(*period, "s", 3))
        }
        Excitation::Harmonic { force, angular_frequency } => {
            format!("harmonic force, {} at {}", quantity(force.abs(), "N", 3), quantity(*angular_frequency, "rad/s", 3))
        }
        Excitation::PulseTrain { duration, period, .. } => {
            format!("pulses of {} every {}", quantity(*duration, "s", 3), quantity(*period, "s", 3))
        }
    };
    write(sheet, At { x: 372.0, y: 40.0 }, &drive, Anchor::Left, VERMILION);
    let mut at = At { x: 600.0, y: 130.0 };
    for note in notes {
        write(sheet, at, &note, Anchor::Left, INK);
        at.y += 46.0;
    }
}

fn face(surface: &Surface) -> String {
    match surface {
        Surface::Rigid { restitution } => format!("rigid, restitution {}", quantity(*restitution, "", 3)),
        Surface::Resilient { stiffness, .. } => format!("resilient, {}", quantity(*stiffness, "N/m", 3)),
    }
}

/// The cavity of a damper in the base, its faces on their springs, and the particle.
fn enclosure(sheet: &Sheet, damper: &Damper) {
    let open = !damper.gap.is_finite();
    let cavity = Rect { left: 230.0, top: if open { 84.0 } else { 120.0 }, right: 450.0, bottom: 400.0 };
    sheet.cell(&cavity, PAPER);
    let walls: &[[At; 2]] = &[
        [At { x: cavity.left, y: cavity.top }, At { x: cavity.left, y: cavity.bottom }],
        [At { x: cavity.right, y: cavity.top }, At { x: cavity.right, y: cavity.bottom }],
    ];
    for wall in walls {
        sheet.line(wall, Pen::solid(INK, CURVE * 0.7));
    }
    let plate = |y: f64| {
        let ends = [At { x: cavity.left + 24.0, y }, At { x: cavity.right - 24.0, y }];
        sheet.line(&ends, Pen::solid(INK, 1.6 * CURVE));
    };
    let mut floor = cavity.bottom;
    if matches!(damper.floor, Surface::Resilient { .. }) {
        floor -= 58.0;
        spring(sheet, At { x: 290.0, y: floor }, At { x: 290.0, y: cavity.bottom });
        dashpot(sheet, At { x: 385.0, y: floor }, At { x: 385.0, y: cavity.bottom });
        plate(floor);
    }
    if !open && matches!(damper.ceiling, Surface::Resilient { .. }) {
        let ceiling = cavity.top + 58.0;
        spring(sheet, At { x: 290.0, y: cavity.top }, At { x: 290.0, y: ceiling });
        dashpot(sheet, At { x: 385.0, y: cavity.top }, At { x: 385.0, y: ceiling });
        plate(ceiling);
    }
    if damper.stop.is_some() {
        for (x, from) in [(340.0, cavity.bottom), (340.0, cavity.top)] {
            let to = if from > 300.0 { from - 24.0 } else { from + 24.0 };
            sheet.line(&[At { x, y: from }, At { x, y: to }], Pen::solid(VERMILION, 2.0 * CURVE));
        }
    }
    if damper.walls.is_some() {
        for side in [[cavity.left - 70.0, cavity.left], [cavity.right, cavity.right + 70.0]] {
            let [from, to] = side.map(|x| At { x, y: 260.0 });
            spring(sheet, from, to);
        }
    }
    let particle = At { x: PLACE, y: floor - 30.0 };
    sheet.disc(particle, 24.0, VERMILION);
}

fn write(sheet: &Sheet, at: At, text: &str, anchor: Anchor, color: Color) {
    sheet.text(at, &Lettering { text, size: NOTE_TEXT, anchor, upright: false, color });
}
