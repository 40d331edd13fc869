//! SVG to PNG with the built-in font. The only file that names resvg.

use std::sync::Arc;

use resvg::{tiny_skia, usvg};

/// DejaVu Sans 2.37; its licence lies beside the file.
pub(super) const FONT: &[u8] = include_bytes!("font/DejaVuSans.ttf");
/// The family that the SVG names.
pub(super) const FAMILY: &str = "DejaVu Sans";

/// Draws an SVG, scaled down by `zoom`, as PNG.
///
/// # Errors
/// What the SVG parser or the PNG encoder says; neither happens for what [`super::canvas`] writes.
pub(super) fn png(svg: &str, zoom: u32) -> Result<Vec<u8>, String> {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    let options = usvg::Options { font_family: FAMILY.to_owned(), fontdb: Arc::new(fonts), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| error.to_string())?;
    let size = tree.size().to_int_size();
    let mut picture = tiny_skia::Pixmap::new(size.width() / zoom, size.height() / zoom)
        .ok_or_else(|| "a picture without pixels".to_owned())?;
    #[expect(clippy::cast_precision_loss, reason = "the zoom is a small whole number")]
    let scale = 1.0 / zoom as f32;
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut picture.as_mut());
    picture.encode_png().map_err(|error| error.to_string())
}
