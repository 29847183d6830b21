//! Decoded images.

/// A decoded image, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// What to call it in messages: usually the file's path.
    pub name: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// The data.
    pub pixels: Pixels,
}

/// Pixel data, interleaved; `channels` is 1 (grey), 3 (RGB) or 4 (RGB and alpha, not premultiplied).
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// Eight bits; whether they are sRGB-encoded is up to the texture that uses them.
    U8 {
        /// 1, 3 or 4.
        channels: u8,
        /// width · height · channels values.
        data: Vec<u8>,
    },
    /// Linear floating point.
    F32 {
        /// 1, 3 or 4.
        channels: u8,
        /// width · height · channels values.
        data: Vec<f32>,
    },
}
