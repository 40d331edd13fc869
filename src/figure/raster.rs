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

/// As a PNG of at most 256 colours where the picture has no more, after rounding each channel to [`SHADES`] shades: a curve is
/// a few colours and the shades at its edges. The file takes a third of one with all shades.
fn encode(picture: &tiny_skia::Pixmap) -> Result<Vec<u8>, RasterError> {
    let failed = |error: png::EncodingError| RasterError::Png(error.to_string());
    let colors: Vec<[u8; 3]> =
        picture.pixels().iter().map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
    for shades in SHADES {
        let Some((palette, indices)) = indexed(&colors, shades) else { continue };
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, picture.width(), picture.height());
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(palette);
        encoder.set_deflate_compression(png::DeflateCompression::Level(LEVEL));
        encoder.set_filter(png::Filter::NoFilter);
        let mut writer = encoder.write_header().map_err(failed)?;
        writer.write_image_data(&indices).map_err(failed)?;
        writer.finish().map_err(failed)?;
        return Ok(bytes);
    }
    picture.encode_png().map_err(|error| RasterError::Png(error.to_string()))
}

/// The highest level, 9, takes six times as long as all else of a picture's encoding, for files that are a fifth smaller.
const LEVEL: u8 = 5;

/// How many shades a channel is rounded to; the first with which 256 colours suffice.
const SHADES: [u32; 5] = [64, 32, 20, 16, 12];

/// The palette and an index a pixel; `None` if the palette would be too long.
fn indexed(colors: &[[u8; 3]], shades: u32) -> Option<(Vec<u8>, Vec<u8>)> {
    let rounded = |channel: u8| {
        let level = (u32::from(channel) * (shades - 1) + 127) / 255;
        u8::try_from((level * 255 + (shades - 1) / 2) / (shades - 1)).unwrap_or(u8::MAX)
    };
    let table: Vec<u8> = (0..=u8::MAX).map(rounded).collect();
    let mut known = std::collections::HashMap::<[u8; 3], u8>::new();
    let mut palette = Vec::new();
    let mut indices = Vec::with_capacity(colors.len());
    // Most pixels are as the one before.
    let mut before: Option<([u8; 3], u8)> = None;
    for color in colors {
        if let Some((same, index)) = before
            && same == *color
        {
            indices.push(index);
            continue;
        }
        let rounded = color.map(|channel| table[usize::from(channel)]);
        let index = match known.get(&rounded) {
            Some(index) => *index,
            None => {
                let index = u8::try_from(known.len()).ok()?;
                palette.extend(rounded);
                known.insert(rounded, index);
                index
            }
        };
        before = Some((*color, index));
        indices.push(index);
    }
    Some((palette, indices))
}
