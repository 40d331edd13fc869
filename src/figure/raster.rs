//! SVG to PNG with the built-in font. The only file that names resvg.

use std::sync::{Arc, LazyLock};

use resvg::{tiny_skia, usvg};

/// DejaVu Sans 2.37; its licence lies beside the file.
pub(super) const FONT: &[u8] = include_bytes!("font/DejaVuSans.ttf");
/// The family that the SVG names.
pub(super) const FAMILY: &str = "DejaVu Sans";

static FONTS: LazyLock<Arc<usvg::fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    Arc::new(fonts)
});

/// Why an SVG has no PNG; what [`super::canvas`] writes always has one.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RasterError {
    /// Not an SVG.
    #[error("the SVG cannot be read: {0}")]
    Svg(String),
    /// No pixel.
    #[error("the picture has no pixels")]
    Empty,
    /// The encoder fails.
    #[error("the PNG cannot be written: {0}")]
    Png(String),
}

/// Draws an SVG as PNG, `density` pixels to a pixel of the SVG.
pub(super) fn png(svg: &str, density: f32) -> Result<Vec<u8>, RasterError> {
    let options =
        usvg::Options { font_family: FAMILY.to_owned(), fontdb: Arc::clone(&FONTS), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| RasterError::Svg(error.to_string()))?;
    let size = tree.size().to_int_size().scale_by(density).ok_or(RasterError::Empty)?;
    let mut picture = tiny_skia::Pixmap::new(size.width(), size.height()).ok_or(RasterError::Empty)?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(density, density), &mut picture.as_mut());
    encode(&picture)
}

/// As a PNG of at most 256 colours where those of the picture lie close enough to as many of them: a curve is a few colours and the
/// shades at its edges. The file takes a third of one with all shades.
fn encode(picture: &tiny_skia::Pixmap) -> Result<Vec<u8>, RasterError> {
    let failed = |error: png::EncodingError| RasterError::Png(error.to_string());
    let colors: Vec<Color> = picture.pixels().iter().map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
    let by_count = by_count(&colors);
    let Some(palette) = ERRORS.iter().find_map(|error| palette(&by_count, colors.len(), *error)) else {
        return picture.encode_png().map_err(|error| RasterError::Png(error.to_string()));
    };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.concat());
    encoder.set_deflate_compression(png::DeflateCompression::Level(LEVEL));
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&indices(&colors, &by_count, &palette)).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// Red, green and blue.
type Color = [u8; 3];

/// The highest level, 9, takes six times as long as all else of a picture's encoding, for files that are a fifth smaller.
const LEVEL: u8 = 5;

/// How far a channel of a pixel may be off, of 255; the first with which 256 colours suffice.
const ERRORS: [u8; 8] = [2, 4, 6, 8, 12, 16, 24, 32];

/// A colour of a larger share of the picture than one in so many pixels is kept as it is: the fill of a band, a line, the ink.
const LARGE: usize = 1000;
/// The most colours that are kept for that.
const KEPT: usize = 128;

/// The colours of a picture, the most frequent first.
fn by_count(colors: &[Color]) -> Vec<(Color, usize)> {
    let mut counts = std::collections::BTreeMap::<Color, usize>::new();
    for run in colors.chunk_by(|a, b| a == b) {
        *counts.entry(run[0]).or_default() += run.len();
    }
    let mut by_count: Vec<_> = counts.into_iter().collect();
    by_count.sort_by_key(|(color, count)| (std::cmp::Reverse(*count), *color));
    by_count
}

/// Colours of the picture, the most frequent first, such that none of its `pixels` is off by more than `error`; `None` if there would be
/// too many.
fn palette(by_count: &[(Color, usize)], pixels: usize, error: u8) -> Option<Vec<Color>> {
    let mut palette: Vec<Color> = Vec::new();
    for (color, count) in by_count {
        let is_kept = palette.len() < KEPT && count * LARGE > pixels;
        if !is_kept && palette.iter().any(|one| distance(*one, *color) <= error) {
            continue;
        }
        if palette.len() > usize::from(u8::MAX) {
            return None;
        }
        palette.push(*color);
    }
    Some(palette)
}

/// Of each pixel the colour of the palette that is nearest to its own.
fn indices(colors: &[Color], by_count: &[(Color, usize)], palette: &[Color]) -> Vec<u8> {
    let nearest = |color: Color| (0..=u8::MAX).zip(palette).min_by_key(|(_, one)| distance(**one, color));
    let known: std::collections::HashMap<Color, u8> =
        by_count.iter().filter_map(|(color, _)| Some((*color, nearest(*color)?.0))).collect();
    let mut indices = Vec::with_capacity(colors.len());
    for run in colors.chunk_by(|a, b| a == b) {
        indices.resize(indices.len() + run.len(), known.get(&run[0]).copied().unwrap_or_default());
    }
    indices
}

/// Largest difference of a channel.
fn distance([r, g, b]: Color, other: Color) -> u8 {
    r.abs_diff(other[0]).max(g.abs_diff(other[1])).max(b.abs_diff(other[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More colours than fit, then two gradients; each with two tints side by side that differ in few shades.
    #[test]
    fn the_tints_of_bands_keep_their_colours_beside_a_map_of_many_colours() {
        let tints = [[206, 222, 236], [206, 229, 219]];
        // Farther apart than any pixel may be off.
        let shades = || (0..8).map(|shade| 33 * shade);
        let pairs = || shades().flat_map(|a| shades().map(move |b| [a, b]));
        let mut colors: Vec<Color> = pairs().flat_map(|[a, b]| shades().map(move |c| [a, b, c])).collect();
        colors.extend([tints[0]; 2000].into_iter().chain([tints[1]; 2000]));
        let by_count = by_count(&colors);
        let palette = ERRORS.iter().find_map(|error| palette(&by_count, colors.len(), *error));
        // So many colours do not fit: the picture keeps all of them.
        assert_eq!(palette, None);

        let mut colors: Vec<Color> = (0..=255).map(|a| [a, 255 - a, a / 2]).collect();
        colors.extend((0..=255).map(|a| [a, a, 200]));
        colors.extend([tints[0]; 2000].into_iter().chain([tints[1]; 2000]));
        let by_count = super::by_count(&colors);
        let palette = ERRORS.iter().find_map(|error| super::palette(&by_count, colors.len(), *error)).unwrap();
        assert!(palette.len() <= 256 && palette[..2].contains(&tints[0]) && palette[..2].contains(&tints[1]));
        for (color, index) in colors.iter().zip(indices(&colors, &by_count, &palette)) {
            let shown = palette[usize::from(index)];
            assert!(distance(shown, *color) <= 4, "{color:?} became {shown:?}");
            assert!(!tints.contains(color) || shown == *color, "{color:?} became {shown:?}");
        }
    }
}
