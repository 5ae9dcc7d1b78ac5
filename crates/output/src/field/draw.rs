//! Drawing a field.

use super::FieldPicture;
use super::frame::{Frame, INK, TICK_SIZE};
use super::levels::{Levels, shown};
use crate::color::viridis;
use crate::contour::{Domain, Line, Outline, Pieces, bands, level_lines};
use crate::svg::{Anchor, Svg, number};

const CONTOUR: &str = " stroke-opacity=\".35\"";
const INTERFACE_WIDTH: f64 = 1.8;
const OUTLINE_WIDTH: f64 = 1.3;

const BAR_GAP: f64 = 18.0;
const BAR_WIDTH: f64 = 16.0;

/// Labels on the colour bar are at least this far apart.
const BAR_LABELS: f64 = 14.0;

/// The whole picture as an SVG document.
pub(super) fn picture(picture: &FieldPicture, width: u32) -> String {
    let frame = Frame::new(picture, width);
    let mut svg = Svg::new(frame.page[0], frame.page[1]);
    let values = shown(&picture.values, picture.log);
    let cuts = picture.cuts_on_grid();
    let domain = picture.domain(&values, &cuts);
    let visible: Vec<f64> = (0..values.len()).filter(|&k| domain.contains(k)).map(|k| values[k]).collect();
    if let Some(levels) = Levels::new(&visible, picture.contours, picture.log) {
        fill(&domain, &levels, &frame, &mut svg);
        interfaces(picture, &frame, &mut svg);
        slits(&cuts, &frame, &mut svg);
        color_bar(&levels, &frame, &mut svg);
    } else {
        let middle = [0, 1].map(|axis| frame.corner[axis] + 0.5 * frame.size[axis]);
        svg.text(middle, "no data", TICK_SIZE, Anchor::Middle, "");
    }
    nodes(picture, &frame, &mut svg);
    frame.draw(picture, &mut svg);
    probes(picture, &frame, &mut svg);
    svg.finish()
}

fn on_page(points: &[[f64; 2]], frame: &Frame) -> Vec<[f64; 2]> {
    points.iter().map(|at| frame.on_grid(at)).collect()
}

fn draw_lines(lines: &[Line], color: &str, width: f64, attributes: &str, frame: &Frame, svg: &mut Svg) {
    let placed: Vec<_> = lines.iter().map(|line| (on_page(&line.points, frame), line.closed)).collect();
    svg.lines(placed.iter().map(|(points, closed)| (points.as_slice(), *closed)), color, width, attributes);
}

/// Bands, contour lines and the outline of the domain, or of each region if their interfaces are not given.
fn fill(domain: &Domain, levels: &Levels, frame: &Frame, svg: &mut Svg) {
    let pieces = Pieces::new(domain);
    for (band, loops) in bands(&pieces, &levels.inner).iter().enumerate() {
        let loops: Vec<_> = loops.iter().map(|points| on_page(points, frame)).collect();
        svg.area(&loops, band_color(band, levels));
    }
    for &level in &levels.inner {
        draw_lines(&level_lines(&pieces, level), "#000", 0.6, CONTOUR, frame, svg);
    }
    if domain.interfaces.is_empty() {
        // The regions' borders are all that shows where they meet.
        for region in domain.regions() {
            draw_outline(&Pieces::of_region(domain, region), frame, svg);
        }
    } else {
        draw_outline(&pieces, frame, svg);
    }
}

fn draw_outline(pieces: &Pieces, frame: &Frame, svg: &mut Svg) {
    let mut outline = Outline::default();
    for piece in pieces.iter() {
        outline.add(piece.iter().map(|v| v.at));
    }
    let loops: Vec<_> = outline.loops().iter().map(|points| on_page(points, frame)).collect();
    svg.lines(loops.iter().map(|points| (points.as_slice(), true)), INK, OUTLINE_WIDTH, "");
}

fn band_color(band: usize, levels: &Levels) -> [u8; 3] {
    match levels.bands() {
        1 => viridis(0.5),
        bands => viridis(band as f64 / (bands - 1) as f64),
    }
}

/// The zero lines of the interfaces, as far as they lie in the domain.
fn interfaces(picture: &FieldPicture, frame: &Frame, svg: &mut Svg) {
    for level in &picture.interfaces {
        let domain = Domain { labels: None, interfaces: &[], ..picture.domain(level, &[]) };
        draw_lines(&level_lines(&Pieces::new(&domain), 0.0), "#000", INTERFACE_WIDTH, "", frame, svg);
    }
}

fn slits(cuts: &[Vec<[f64; 2]>], frame: &Frame, svg: &mut Svg) {
    let placed: Vec<_> = cuts.iter().map(|line| on_page(line, frame)).collect();
    svg.lines(placed.iter().map(|points| (points.as_slice(), false)), "#000", INTERFACE_WIDTH, "");
}

fn color_bar(levels: &Levels, frame: &Frame, svg: &mut Svg) {
    let height = frame.size[1].max(100.0);
    let top = frame.corner[1] + 0.5 * (frame.size[1] - height);
    let left = frame.corner[0] + frame.size[0] + BAR_GAP;
    let span = levels.hi - levels.lo;
    let y = |value: f64| top + height * if span > 0.0 { (levels.hi - value) / span } else { 0.5 };
    let mut bounds = vec![levels.lo];
    bounds.extend(&levels.inner);
    bounds.push(levels.hi);
    for band in 0..levels.bands() {
        let (upper, lower) = match levels.bands() {
            1 => (top, top + height),
            _ => (y(bounds[band + 1]), y(bounds[band])),
        };
        let right = left + BAR_WIDTH;
        svg.area(
            &[vec![[left, upper], [right, upper], [right, lower], [left, lower]]],
            band_color(band, levels),
        );
    }
    let [right, bottom] = [left + BAR_WIDTH, top + height];
    let border = [[left, top], [right, top], [right, bottom], [left, bottom]];
    svg.lines([(border.as_slice(), true)].into_iter(), INK, 0.8, "");
    let (labelled, factor) = levels.labels();
    let apart = (bottom - top) / labelled.len() as f64;
    let stride = (BAR_LABELS / apart).ceil().max(1.0) as usize;
    for (level, text) in labelled.iter().step_by(stride) {
        let at = y(*level);
        svg.line([right, at], [right + 4.0, at], INK, 0.8);
        svg.text([right + 8.0, at], text, TICK_SIZE, Anchor::Start, "");
    }
    svg.text([left, top - 9.0], &factor, TICK_SIZE, Anchor::Start, "");
}

fn nodes(picture: &FieldPicture, frame: &Frame, svg: &mut Svg) {
    let dots: Vec<[f64; 2]> =
        picture.nodes.iter().filter(|x| frame.shows(**x)).map(|x| frame.place(*x)).collect();
    let dots = dots.chunks(1).map(|dot| (dot, false));
    svg.lines(dots, "#000", 1.7, " stroke-linecap=\"round\" stroke-opacity=\".6\"");
}

/// Rings with names, legible on any colour.
fn probes(picture: &FieldPicture, frame: &Frame, svg: &mut Svg) {
    for probe in picture.probes.iter().filter(|probe| frame.shows(probe.at)) {
        let [x, y] = frame.place(probe.at);
        svg.raw(&format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"3.5\" fill=\"#fff\" stroke=\"#000\" stroke-width=\"1.4\"/>",
            number(x),
            number(y)
        ));
        let halo = " stroke=\"#fff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
        // Near the right border the name stands on the left.
        let (at, anchor) = if x > frame.corner[0] + 0.8 * frame.size[0] {
            ([x - 8.0, y], Anchor::End)
        } else {
            ([x + 8.0, y], Anchor::Start)
        };
        svg.text(at, &probe.name, TICK_SIZE, anchor, halo);
    }
}
