//! Colours: a perceptual scale for fields, and hues for lines that colour-blind readers tell apart.

/// Red, green, blue.
pub(crate) type Rgb = [u8; 3];

/// Hues of Okabe & Ito (2008, "Color universal design"), ordered for contrast between neighbours; yellow, which vanishes
/// on white paper, is left out.
pub(crate) const HUES: [Rgb; 7] = [
    [0x00, 0x72, 0xb2],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0x56, 0xb4, 0xe9],
    [0xe6, 0x9f, 0x00],
    [0x00, 0x00, 0x00],
];

/// Sixteen colours of viridis (S. van der Walt and N. Smith, 2015, public domain): lightness grows evenly, so it reads
/// in black and white too.
const VIRIDIS: [Rgb; 16] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x1a, 0x6c],
    [0x47, 0x2f, 0x7d],
    [0x41, 0x44, 0x87],
    [0x39, 0x56, 0x8c],
    [0x31, 0x68, 0x8e],
    [0x2a, 0x78, 0x8e],
    [0x23, 0x88, 0x8e],
    [0x1f, 0x98, 0x8b],
    [0x22, 0xa8, 0x84],
    [0x35, 0xb7, 0x79],
    [0x54, 0xc5, 0x68],
    [0x7a, 0xd1, 0x51],
    [0xa5, 0xdb, 0x36],
    [0xd2, 0xe2, 0x1b],
    [0xfd, 0xe7, 0x25],
];

/// The colour at `t` between 0 (dark) and 1 (light).
pub(crate) fn viridis(t: f64) -> Rgb {
    let place = t.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let below = (place.floor() as usize).min(VIRIDIS.len() - 2);
    let weight = place - below as f64;
    std::array::from_fn(|channel| {
        let (a, b) = (f64::from(VIRIDIS[below][channel]), f64::from(VIRIDIS[below + 1][channel]));
        (a + weight * (b - a)).round() as u8
    })
}

/// `#rrggbb`.
pub(crate) fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
