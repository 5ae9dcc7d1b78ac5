//! Drawing a chart. This is the only file that names plotters.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::frame::{Frame, Place, Range};
use super::{Chart, Series, Stroke};
use crate::color::HUES;
use crate::error::OutputError;

/// plotters rounds positions to whole pixels; the chart is drawn this many times larger and scaled down by the SVG
/// view box, so that lines are smooth.
const OVERSAMPLING: u32 = 10;

/// plotters divides font sizes by this number when it writes SVG.
const FONT_FACTOR: f64 = 1.24;

const TITLE_SIZE: f64 = 15.0;
const LABEL_SIZE: f64 = 13.0;
const TICK_SIZE: f64 = 12.0;

/// Width of a character, relative to the font size: what a sans-serif font has on average.
const CHARACTER_WIDTH: f64 = 0.58;

/// Radius of a marker, and of the markers of a series with many points.
const MARKER: f64 = 4.2;
const SMALL_MARKER: f64 = 2.4;
const MANY_POINTS: usize = 25;

const INK: RGBColor = RGBColor(40, 40, 40);
const PALE: RGBColor = RGBColor(236, 236, 236);
const GRID: RGBColor = RGBColor(212, 212, 212);
const REFERENCE: RGBColor = RGBColor(110, 110, 110);

type Pixel = (i32, i32);
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Axes = Cartesian2d<Range, Range>;
type Context<'a> = ChartContext<'a, SVGBackend<'a>, Axes>;

pub(super) fn chart(chart: &Chart, width: u32, height: u32) -> Result<String, OutputError> {
    let (large_width, large_height) = (width * OVERSAMPLING, height * OVERSAMPLING);
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (large_width, large_height)).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        draw(chart, &root, f64::from(width), f64::from(height))?;
        root.present().map_err(failed)?;
    }
    let drawn = format!("<svg width=\"{large_width}\" height=\"{large_height}\"");
    let shown = format!("<svg width=\"{width}\" height=\"{height}\"");
    Ok(svg.replacen(&drawn, &shown, 1))
}

fn draw(chart: &Chart, root: &Area, width: f64, height: f64) -> Result<(), OutputError> {
    let Some(frame) = Frame::new(chart, (width / 90.0) as usize, (height / 60.0) as usize) else {
        write(root, "no data", (0.5 * width, 0.5 * height), LABEL_SIZE, INK, HPos::Center)?;
        return write(root, &chart.title, (0.5 * width, 16.0), TITLE_SIZE, INK, HPos::Center);
    };
    let legend = legend_width(chart).min(0.45 * width);
    let (plot, side) = root.split_horizontally(px(width - legend));
    let mut builder = ChartBuilder::on(&plot);
    builder
        .margin_top(px(if chart.title.is_empty() { 14.0 } else { 34.0 }))
        .margin_right(px(16.0))
        .margin_bottom(px(6.0))
        .margin_left(px(6.0))
        .x_label_area_size(px(TICK_SIZE + LABEL_SIZE + 15.0))
        .y_label_area_size(px(longest(&frame.y) * TICK_SIZE * CHARACTER_WIDTH + LABEL_SIZE + 22.0));
    let mut context = builder.build_cartesian_2d(frame.x.clone(), frame.y.clone()).map_err(failed)?;
    mesh(chart, &frame, &mut context)?;
    references(&frame, &mut context)?;
    // Exact curves lie beneath the points that are compared with them.
    let numbered = chart.series.iter().enumerate();
    let (curves, others): (Vec<_>, Vec<_>) = numbered.partition(|(_, series)| series.stroke == Stroke::Curve);
    for (number, series) in curves.into_iter().chain(others) {
        draw_series(number, series, &frame.runs[number], &mut context)?;
    }
    write(root, &chart.title, (0.5 * (width - legend), 18.0), TITLE_SIZE, INK, HPos::Center)?;
    draw_legend(chart, &side, legend)
}

/// The larger pixels of a length.
fn px(length: f64) -> i32 {
    (length * f64::from(OVERSAMPLING)).round() as i32
}

fn font(size: f64) -> TextStyle<'static> {
    ("sans-serif", size * FONT_FACTOR * f64::from(OVERSAMPLING)).into_font().color(&INK)
}

fn failed(error: impl std::fmt::Display) -> OutputError {
    OutputError::Drawing(error.to_string())
}

/// Length of the longest tick label in characters.
fn longest(range: &Range) -> f64 {
    range.labelled.iter().map(|tick| tick.1.chars().count()).max().unwrap_or(0) as f64
}

impl Ranged for Range {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        // What is far outside stays just outside: pixels are counted in 32 bits.
        let fraction = ((value - self.lo) / (self.hi - self.lo)).clamp(-1.0, 2.0);
        limit.0 + (fraction * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let labelled = self.labelled.iter().map(|tick| tick.0);
        if hint.weight().allow_light_points() { self.minor.clone() } else { labelled.collect() }
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.lo..self.hi
    }
}

impl ValueFormatter<f64> for Range {
    fn format_ext(&self, value: &f64) -> String {
        self.labelled.iter().find(|tick| tick.0 == *value).map_or_else(String::new, |tick| tick.1.clone())
    }
}

fn write(
    area: &Area,
    text: &str,
    at: (f64, f64),
    size: f64,
    color: RGBColor,
    h: HPos,
) -> Result<(), OutputError> {
    if text.is_empty() {
        return Ok(());
    }
    let style = font(size).color(&color).pos(Pos::new(h, VPos::Center));
    area.draw_text(&printable(text), &style, (px(at.0), px(at.1))).map_err(failed)
}

/// Control characters are not allowed in XML.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

fn mesh(chart: &Chart, frame: &Frame, context: &mut Context) -> Result<(), OutputError> {
    context
        .configure_mesh()
        .bold_line_style(GRID.stroke_width(px(0.7).unsigned_abs()))
        .light_line_style(PALE.stroke_width(px(0.5).unsigned_abs()))
        .axis_style(INK.stroke_width(px(1.0).unsigned_abs()))
        .x_labels(frame.x.labelled.len() + 1)
        .y_labels(frame.y.labelled.len() + 1)
        .label_style(font(TICK_SIZE))
        .axis_desc_style(font(LABEL_SIZE))
        .x_desc(described(&chart.x.label, &frame.x))
        .y_desc(described(&chart.y.label, &frame.y))
        .set_all_tick_mark_size(px(4.0))
        .draw()
        .map_err(failed)
}

/// An axis' label with the factor that its tick labels have in common.
fn described(label: &str, range: &Range) -> String {
    let text = if range.factor.is_empty() { label.to_owned() } else { format!("{label} ({})", range.factor) };
    printable(&text)
}

fn references(frame: &Frame, context: &mut Context) -> Result<(), OutputError> {
    for line in &frame.references {
        let style = REFERENCE.stroke_width(px(1.1).unsigned_abs());
        let dashes = DashedPathElement::new([line.from, line.to], px(6.0), px(4.0), style);
        context.draw_series([dashes]).map_err(failed)?;
        let style = font(TICK_SIZE - 1.0).color(&REFERENCE).pos(Pos::new(HPos::Left, VPos::Center));
        let label = EmptyElement::at(line.to) + Text::new(line.label.clone(), (px(6.0), 0), style);
        context.draw_series([label]).map_err(failed)?;
    }
    Ok(())
}

fn hue(number: usize) -> RGBColor {
    let [r, g, b] = HUES[number % HUES.len()];
    RGBColor(r, g, b)
}

fn line(number: usize, series: &Series) -> ShapeStyle {
    match series.stroke {
        Stroke::Curve => INK.stroke_width(px(1.0).unsigned_abs()),
        _ => hue(number).stroke_width(px(1.6).unsigned_abs()),
    }
}

fn draw_series(
    number: usize,
    series: &Series,
    runs: &[Vec<Place>],
    context: &mut Context,
) -> Result<(), OutputError> {
    let points: usize = runs.iter().map(Vec::len).sum();
    for run in runs {
        if series.stroke.has_line() {
            context.draw_series([PathElement::new(run.clone(), line(number, series))]).map_err(failed)?;
        }
        if series.stroke.has_markers() {
            let size = if points > MANY_POINTS { SMALL_MARKER } else { MARKER };
            let marks = run.iter().map(|&at| {
                let (area, edge) = marker(number, size);
                EmptyElement::at(at) + area + edge
            });
            context.draw_series(marks).map_err(failed)?;
        }
    }
    Ok(())
}

/// Outline of a marker of about the area of a circle of radius 1.
fn outline(number: usize) -> Vec<(f64, f64)> {
    let regular = |corners: usize, radius: f64, turn: f64| -> Vec<(f64, f64)> {
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / corners as f64 + turn;
        (0..corners).map(|k| (radius * angle(k).sin(), -radius * angle(k).cos())).collect()
    };
    let eighth = std::f64::consts::FRAC_PI_4;
    match number % 7 {
        0 => regular(24, 1.0, 0.0),
        1 => regular(4, 1.25, eighth),
        2 => regular(3, 1.5, 0.0),
        3 => regular(4, 1.3, 0.0),
        4 => regular(3, 1.5, std::f64::consts::PI),
        5 => regular(5, 1.3, 0.0),
        // A cross.
        _ => {
            let (a, b) = (0.4, 1.2);
            vec![
                (a, b),
                (a, a),
                (b, a),
                (b, -a),
                (a, -a),
                (a, -b),
                (-a, -b),
                (-a, -a),
                (-b, -a),
                (-b, a),
                (-a, a),
                (-a, b),
            ]
        }
    }
}

/// A marker, as an area and its edge: filled in the first round through the palette, hollow in the second.
fn marker(number: usize, size: f64) -> (Polygon<Pixel>, PathElement<Pixel>) {
    let mut points: Vec<(i32, i32)> =
        outline(number).iter().map(|p| (px(size * p.0), px(size * p.1))).collect();
    let hollow = number / HUES.len() % 2 == 1;
    let fill = if hollow { WHITE } else { hue(number) };
    let area = Polygon::new(points.clone(), fill.filled());
    points.push(points[0]);
    (area, PathElement::new(points, hue(number).stroke_width(px(1.0).unsigned_abs())))
}

/// Width of the column for the legend, none if no series has a name.
fn legend_width(chart: &Chart) -> f64 {
    let longest = chart.series.iter().map(|series| series.name.chars().count()).max().unwrap_or(0);
    if longest == 0 { 0.0 } else { longest as f64 * TICK_SIZE * CHARACTER_WIDTH + 48.0 }
}

fn draw_legend(chart: &Chart, side: &Area, width: f64) -> Result<(), OutputError> {
    let named = chart.series.iter().enumerate().filter(|(_, series)| !series.name.is_empty());
    let room = ((width - 48.0) / (TICK_SIZE * CHARACTER_WIDTH)).max(1.0).round() as usize;
    for (row, (number, series)) in named.enumerate() {
        let y = 46.0 + 20.0 * row as f64;
        if series.stroke.has_line() {
            let ends = vec![(px(2.0), px(y)), (px(30.0), px(y))];
            side.draw(&PathElement::new(ends, line(number, series))).map_err(failed)?;
        }
        if series.stroke.has_markers() {
            let (area, edge) = marker(number, MARKER);
            side.draw(&(EmptyElement::at((px(16.0), px(y))) + area + edge)).map_err(failed)?;
        }
        let mut name: String = series.name.chars().take(room).collect();
        if name.len() < series.name.len() {
            name.pop();
            name.push('…');
        }
        write(side, &name, (37.0, y), TICK_SIZE, INK, HPos::Left)?;
    }
    Ok(())
}
