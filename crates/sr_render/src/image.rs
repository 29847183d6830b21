//! A finished (or interrupted) image: means, standard errors and features, row by row from the top.

/// What a film amounts to.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderedImage {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Samples per pixel.
    pub spp: u32,
    /// Mean radiance, linear RGB: height · width · 3 values.
    pub rgb: Vec<f32>,
    /// Standard error of that mean, per channel; infinite with fewer than two samples.
    pub stderr: Vec<f32>,
    /// Mean albedo at the first hit, RGB.
    pub albedo: Vec<f32>,
    /// Mean shading normal at the first hit, world space.
    pub normal: Vec<f32>,
    /// Mean distance from the camera to the first hit; infinite where there is none.
    pub depth: Vec<f32>,
    /// The fraction of samples that hit something.
    pub alpha: Vec<f32>,
}

/// Luminance of linear sRGB (ITU-R BT.709).
pub fn luminance(rgb: [f64; 3]) -> f64 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

impl RenderedImage {
    pub(crate) fn black(width: u32, height: u32, spp: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            width,
            height,
            spp,
            rgb: vec![0.0; 3 * pixels],
            stderr: vec![f32::INFINITY; 3 * pixels],
            albedo: vec![0.0; 3 * pixels],
            normal: vec![0.0; 3 * pixels],
            depth: vec![f32::INFINITY; pixels],
            alpha: vec![0.0; pixels],
        }
    }

    /// Width times height.
    pub fn pixel_count(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The mean of all pixels, per channel.
    pub fn mean(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for pixel in self.rgb.chunks_exact(3) {
            for (s, &v) in sum.iter_mut().zip(pixel) {
                *s += f64::from(v);
            }
        }
        sum.map(|s| s / self.pixel_count() as f64)
    }

    /// The standard error of [`RenderedImage::mean`]; pixels are independent.
    pub fn mean_stderr(&self) -> [f64; 3] {
        let mut variance = [0.0; 3];
        for pixel in self.stderr.chunks_exact(3) {
            for (s, &v) in variance.iter_mut().zip(pixel) {
                *s += f64::from(v) * f64::from(v);
            }
        }
        variance.map(|v| v.sqrt() / self.pixel_count() as f64)
    }

    /// The mean over pixels of the standard error of the luminance, over the mean luminance.
    ///
    /// One number for "how noisy is it": 0.05 is an image whose typical pixel is off by 5 % of the
    /// image's brightness. The three channels of a pixel are taken as fully correlated, as they nearly
    /// are. Infinite with fewer than two samples, NaN for a black image.
    pub fn mean_relative_error(&self) -> f64 {
        let sum = |values: &[f32]| -> f64 {
            values.chunks_exact(3).map(|p| luminance([p[0], p[1], p[2]].map(f64::from))).sum()
        };
        sum(&self.stderr) / sum(&self.rgb)
    }
}
