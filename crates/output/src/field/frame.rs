//! Where the parts of a picture go, and its axes.

use super::FieldPicture;
use crate::svg::{Anchor, Svg};
use crate::ticks::{labels, linear_ticks};

pub(super) const TITLE_SIZE: f64 = 15.0;
pub(super) const TICK_SIZE: f64 = 12.0;

/// Lines of the frame, the ticks and the outline of the domain.
pub(super) const INK: &str = "#282828";

const LEFT: f64 = 62.0;
const RIGHT: f64 = 110.0;
const BOTTOM: f64 = 36.0;
const TOP: f64 = 18.0;
const TOP_WITH_TITLE: f64 = 40.0;

/// Smallest height of the area for the plot: room for a readable colour bar.
const SMALLEST: f64 = 120.0;

/// Largest height of the plot in units of the page's width.
const TALLEST: f64 = 1.6;

/// The plot on the page: both directions have the same scale.
pub(super) struct Frame {
    pub(super) page: [f64; 2],
    /// Upper left corner of the plot.
    pub(super) corner: [f64; 2],
    /// Width and height of the plot.
    pub(super) size: [f64; 2],
    /// Pixels for each unit of length.
    scale: f64,
    /// Lower left corner of the rectangle that is shown.
    min: [f64; 2],
    /// Pixels from one grid node to the next.
    spacing: [f64; 2],
}

impl Frame {
    pub(super) fn new(picture: &FieldPicture, width: u32) -> Self {
        let width = f64::from(width);
        let extent = [0, 1].map(|axis| picture.max[axis] - picture.min[axis]);
        let room = width - LEFT - RIGHT;
        let scale = (room / extent[0]).min(TALLEST * width / extent[1]);
        let size = extent.map(|length| scale * length);
        let top = if picture.title.is_empty() { TOP } else { TOP_WITH_TITLE };
        let height = size[1].max(SMALLEST);
        Self {
            page: [width, top + height + BOTTOM],
            corner: [LEFT + 0.5 * (room - size[0]), top + 0.5 * (height - size[1])],
            size,
            scale,
            min: picture.min,
            spacing: [size[0] / (picture.nx - 1) as f64, size[1] / (picture.ny - 1) as f64],
        }
    }

    /// Where a position of the field lies on the page.
    pub(super) fn place(&self, x: [f64; 2]) -> [f64; 2] {
        self.up([self.scale * (x[0] - self.min[0]), self.scale * (x[1] - self.min[1])])
    }

    /// Where a position on the grid, in units of its spacing, lies on the page.
    pub(super) fn on_grid(&self, at: &[f64; 2]) -> [f64; 2] {
        self.up([self.spacing[0] * at[0], self.spacing[1] * at[1]])
    }

    fn up(&self, from_corner: [f64; 2]) -> [f64; 2] {
        [self.corner[0] + from_corner[0], self.corner[1] + self.size[1] - from_corner[1]]
    }

    /// Whether a position is within the plot.
    pub(super) fn shows(&self, x: [f64; 2]) -> bool {
        let place = self.place(x);
        (0..2).all(|axis| {
            let offset = place[axis] - self.corner[axis];
            offset >= -1e-6 && offset <= self.size[axis] + 1e-6
        })
    }

    /// Border, ticks and their labels, and the title.
    pub(super) fn draw(&self, picture: &FieldPicture, svg: &mut Svg) {
        let ([left, top], [width, height]) = (self.corner, self.size);
        let (right, bottom) = (left + width, top + height);
        let border = [[left, top], [right, top], [right, bottom], [left, bottom]];
        svg.lines([(border.as_slice(), true)].into_iter(), INK, 0.8, "");
        let (ticks, step) = linear_ticks(picture.min[0], picture.max[0], ((width / 80.0) as usize).max(1));
        let texts = labels(&ticks, step);
        for (tick, text) in ticks.into_iter().zip(texts.texts) {
            let [x, _] = self.place([tick, picture.min[1]]);
            svg.line([x, bottom], [x, bottom + 5.0], INK, 0.8);
            svg.text([x, bottom + 15.0], &text, TICK_SIZE, Anchor::Middle, "");
        }
        svg.text([right, bottom + 29.0], &texts.factor, TICK_SIZE, Anchor::End, "");
        let (ticks, step) = linear_ticks(picture.min[1], picture.max[1], ((height / 60.0) as usize).max(1));
        let texts = labels(&ticks, step);
        for (tick, text) in ticks.into_iter().zip(texts.texts) {
            let [_, y] = self.place([picture.min[0], tick]);
            svg.line([left - 5.0, y], [left, y], INK, 0.8);
            svg.text([left - 9.0, y], &text, TICK_SIZE, Anchor::End, "");
        }
        svg.text([left, top - 9.0], &texts.factor, TICK_SIZE, Anchor::Start, "");
        svg.text([left + 0.5 * width, 18.0], &picture.title, TITLE_SIZE, Anchor::Middle, "");
    }
}
