//! PNG bytes of a bitmap.

use super::error::ReportError;
use plotters::prelude::{BitMapBackend, DrawingBackend};

/// Encodes rows of RGB pixels as a PNG file.
///
/// plotters encodes only into files, so the bytes take the way through a temporary one.
pub(super) fn encode(pixels: &[u8], (width, height): (u32, u32)) -> Result<Vec<u8>, ReportError> {
    let file = tempfile::Builder::new()
        .suffix(".png")
        .tempfile()
        .map_err(|source| ReportError::Write {
            path: std::env::temp_dir(),
            source,
        })?;
    let draw = || {
        let mut backend = BitMapBackend::new(file.path(), (width, height));
        backend.blit_bitmap((0, 0), (width, height), pixels)?;
        backend.present()
    };
    draw().map_err(|error| ReportError::Draw(error.to_string()))?;
    std::fs::read(file.path()).map_err(|source| ReportError::Write {
        path: file.path().to_path_buf(),
        source,
    })
}

/// Half the size in both directions, each pixel the mean of four; `width` and `height` are even.
pub(super) fn halve(pixels: &[u8], width: u32, height: u32) -> Vec<u8> {
    let row = 3 * width as usize;
    let mut out = Vec::with_capacity(pixels.len() / 4);
    for y in 0..height as usize / 2 {
        let (upper, lower) = (&pixels[2 * y * row..], &pixels[(2 * y + 1) * row..]);
        for x in 0..width as usize / 2 {
            for channel in 0..3 {
                let (a, b) = (6 * x + channel, 6 * x + 3 + channel);
                let sum = [upper[a], upper[b], lower[a], lower[b]].map(u16::from);
                out.push(((sum.iter().sum::<u16>() + 2) / 4) as u8);
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halving_takes_means() {
        let pixels: Vec<u8> = [[0, 0, 0], [100, 8, 0], [100, 0, 0], [200, 0, 3]].concat();
        assert_eq!(halve(&pixels, 2, 2), [100, 2, 1]);
    }

    #[test]
    fn bytes_are_a_png_of_the_right_size() {
        let bytes = encode(&[200; 18], (3, 2)).unwrap();
        assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
        assert_eq!(bytes[16..24], [0, 0, 0, 3, 0, 0, 0, 2]);
    }
}
