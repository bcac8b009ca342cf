//! Plots as SVG: measured series as lines and points with their deviations, analytic references as
//! dashed lines, points of the source as circles.
//!
//! Colors are written as attributes, so that the style of a dark page can replace them.

use plotters::{
    backend::SVGBackend,
    chart::{ChartBuilder, ChartContext},
    coord::{Shift, cartesian::Cartesian2d},
    drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea},
    element::{Circle, PathElement, Text},
    series::DashedLineSeries,
    style::{
        Color, RGBColor, TextStyle, WHITE,
        text_anchor::{HPos, Pos, VPos},
    },
};

use super::axis::Axis;
use crate::experiments::findings::{Kind, Plot, Series};

/// Width and height of a plot (pixels); pages scale it.
const SIZE: (u32, u32) = (1440, 840);
/// Colors of the series, which people with color blindness can distinguish (Okabe & Ito 2008, with
/// a darker yellow), and their replacements on dark pages.
const COLORS: [(&str, &str); 8] = [
    ("#0072B2", "#5BB4F0"),
    ("#D55E00", "#FF9352"),
    ("#009E73", "#3ED6A8"),
    ("#CC79A7", "#EBA4CB"),
    ("#B8860B", "#E5BC4D"),
    ("#56B4E9", "#A9DCFA"),
    ("#6A3D9A", "#B99AE0"),
    ("#7F4F24", "#C99B6D"),
];
/// Replacements of the colors of ink and grid on dark pages.
const DARK_COLORS: [(&str, &str); 2] = [("#333A44", "#C3CBD4"), ("#E3E6EA", "#313943")];
/// Color of a series that refers to all others.
const NEUTRAL_COLOR: &str = "#333A44";
/// Color of axes and labels.
const INK: RGBColor = RGBColor(0x33, 0x3a, 0x44);
/// Color of grid lines.
const GRID: RGBColor = RGBColor(0xe3, 0xe6, 0xea);
/// Width of a line (pixels).
const LINE_WIDTH: u32 = 4;
/// Radius of a point (pixels).
const POINT_RADIUS: u32 = 7;
/// Height of a line of the legend (pixels).
const LEGEND_LINE: u32 = 48;
/// Left edge of the legend (pixels).
const LEGEND_LEFT: u32 = 40;
/// Space for the sample before a label (pixels).
const LEGEND_SAMPLE: u32 = 76;
/// Approximate width of a letter (pixels).
const LETTER_WIDTH: u32 = 17;
/// Points of a line above which a plot would only get larger, not better.
const N_POINTS_MAX: usize = 500;

type DrawError<'a> =
    DrawingAreaErrorKind<<SVGBackend<'a> as plotters::prelude::DrawingBackend>::ErrorType>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

/// The plot as an `<svg>` element of a page that has the legend and the background.
pub fn svg(plot: &Plot) -> String {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        draw(plot, &area).expect("memory is the only limit");
        area.present().expect("memory is the only limit");
    }
    // The width is set by the page.
    text.replacen(&format!("width=\"{}\" height=\"{}\" ", SIZE.0, SIZE.1), "", 1)
}

/// The plot as a standalone file: on white, with its legend above.
pub fn standalone_svg(plot: &Plot) -> String {
    let positions = legend_positions(plot);
    let n_lines = positions.last().map_or(0, |position| position.1 + 1);
    let height = 20 + LEGEND_LINE * n_lines;
    let mut text = String::new();
    {
        let size = (SIZE.0, SIZE.1 + height);
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        area.fill(&WHITE).expect("memory is the only limit");
        let (legend, rest) = area.split_vertically(height);
        draw_legend(plot, &positions, &legend).expect("memory is the only limit");
        draw(plot, &rest).expect("memory is the only limit");
        area.present().expect("memory is the only limit");
    }
    text
}

/// The positions of the legend entries: from the left (pixels), and the line.
fn legend_positions(plot: &Plot) -> Vec<(u32, u32)> {
    let (mut x, mut line) = (LEGEND_LEFT, 0);
    let mut positions = Vec::new();
    for series in &plot.series {
        let n = u32::try_from(series.label.chars().count()).unwrap_or(0);
        let width = LEGEND_SAMPLE + LETTER_WIDTH * n + 50;
        if SIZE.0 < x + width && LEGEND_LEFT < x {
            (x, line) = (LEGEND_LEFT, line + 1);
        }
        positions.push((x, line));
        x += width;
    }
    positions
}

fn draw_legend<'b>(
    plot: &Plot,
    positions: &[(u32, u32)],
    area: &DrawingArea<SVGBackend<'b>, Shift>,
) -> Result<(), DrawError<'b>> {
    let pixel = |it: u32| i32::try_from(it).unwrap_or(i32::MAX);
    let label = TextStyle::from(("sans-serif", 37)).color(&INK);
    let label = label.pos(Pos::new(HPos::Left, VPos::Center));
    for ((series, color), (x, line)) in plot.series.iter().zip(colors(plot)).zip(positions) {
        let (color, x, y) = (rgb(color), pixel(*x), pixel(20 + LEGEND_LINE * line + 30));
        let (end, middle) = (x + 60, (x + 30, y));
        let stroke = color.stroke_width(LINE_WIDTH);
        match series.kind {
            Kind::Line => area.draw(&PathElement::new([(x, y), (end, y)], stroke))?,
            Kind::Analytic => {
                for from in [x, x + 24, x + 48] {
                    area.draw(&PathElement::new([(from, y), (from + 14, y)], stroke))?;
                }
            }
            Kind::Points => area.draw(&Circle::new(middle, POINT_RADIUS + 1, color.filled()))?,
            Kind::Source => {
                area.draw(&Circle::new(middle, POINT_RADIUS + 2, color.stroke_width(3)))?
            }
        }
        area.draw(&Text::new(series.label.as_str(), (x + pixel(LEGEND_SAMPLE), y), label.clone()))?;
    }
    Ok(())
}

/// The colors of a plot's series. If there are as many references or source points as measured
/// series, they share colors one by one; a single one refers to all.
pub fn colors(plot: &Plot) -> Vec<&'static str> {
    let is_measured = |kind: Kind| matches!(kind, Kind::Line | Kind::Points);
    let count = |is: &dyn Fn(Kind) -> bool| plot.series.iter().filter(|it| is(it.kind)).count();
    let n_measured = count(&is_measured);
    let mut n_others = n_measured;
    let mut earlier = Vec::new();
    let mut colors = Vec::new();
    for kind in plot.series.iter().map(|series| series.kind) {
        let same = |it: &Kind| *it == kind || is_measured(*it) && is_measured(kind);
        let k = earlier.iter().filter(|it| same(it)).count();
        let n = if is_measured(kind) { n_measured } else { count(&|it| it == kind) };
        colors.push(if n == n_measured {
            COLORS[k % COLORS.len()].0
        } else if n == 1 {
            NEUTRAL_COLOR
        } else {
            n_others += 1;
            COLORS[(n_others - 1) % COLORS.len()].0
        });
        earlier.push(kind);
    }
    colors
}

/// Pairs of a color and its replacement on dark pages.
pub fn dark_colors() -> impl Iterator<Item = (&'static str, &'static str)> {
    COLORS.into_iter().chain(DARK_COLORS)
}

/// A plot reduced to what is visible: long lines are thinned, numbers have six digits. The CSV
/// files of the curves keep everything.
pub fn reduced(mut plot: Plot) -> Plot {
    for series in &mut plot.series {
        let is_line = matches!(series.kind, Kind::Line | Kind::Analytic);
        if is_line && N_POINTS_MAX < series.points.len() {
            let kept = extremes(&series.points);
            let deviation = |i: &usize| series.deviations.get(*i).copied();
            series.deviations = kept.iter().filter_map(deviation).collect();
            series.points = kept.iter().map(|i| series.points[*i]).collect();
        }
        series.points.iter_mut().flatten().chain(&mut series.deviations).for_each(round);
    }
    plot
}

/// Indices of the lowest and the highest point of every short section.
fn extremes(points: &[[f64; 2]]) -> Vec<usize> {
    let section = points.len().div_ceil(N_POINTS_MAX / 2);
    let mut kept = Vec::new();
    for start in (0..points.len()).step_by(section) {
        let here = start..points.len().min(start + section);
        let by_height = |a: &usize, b: &usize| points[*a][1].total_cmp(&points[*b][1]);
        let low = here.clone().min_by(by_height).unwrap_or(start);
        let high = here.max_by(by_height).unwrap_or(start);
        kept.push(low.min(high));
        if low != high {
            kept.push(low.max(high));
        }
    }
    kept
}

fn round(value: &mut f64) {
    if let Ok(rounded) = format!("{value:.5e}").parse() {
        *value = rounded;
    }
}

fn draw<'b>(plot: &Plot, area: &DrawingArea<SVGBackend<'b>, Shift>) -> Result<(), DrawError<'b>> {
    let (x, y) = axes(plot);
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .margin_right(30)
        .x_label_area_size(96)
        .y_label_area_size(150)
        .build_cartesian_2d(x.clone(), y.clone())?;
    let numbers = TextStyle::from(("sans-serif", 37)).color(&INK);
    chart
        .configure_mesh()
        .bold_line_style(GRID.stroke_width(2))
        .light_line_style(GRID.mix(0.0))
        .axis_style(INK.stroke_width(2))
        .set_all_tick_mark_size(8)
        .label_style(numbers.clone())
        .axis_desc_style(TextStyle::from(("sans-serif", 39)).color(&INK))
        .x_desc(plot.x_label.as_str())
        .y_desc(plot.y_label.as_str())
        .draw()?;
    for (series, color) in plot.series.iter().zip(colors(plot)) {
        draw_series(&mut chart, series.kind, rgb(color), &visible(series, &x, &y), y.lowest())?;
    }
    Ok(())
}

/// A point and the deviation of its y value.
type Dot = ((f64, f64), f64);

fn draw_series<'b>(
    chart: &mut Chart<'_, 'b>,
    kind: Kind,
    color: RGBColor,
    dots: &[Dot],
    lowest: f64,
) -> Result<(), DrawError<'b>> {
    let line = color.stroke_width(LINE_WIDTH);
    let path: Vec<(f64, f64)> = dots.iter().map(|dot| dot.0).collect();
    let bars = dots.iter().filter(|dot| 0.0 < dot.1).map(|&((x, y), deviation)| {
        let ends = vec![(x, (y - deviation).max(lowest)), (x, y + deviation)];
        PathElement::new(ends, color.stroke_width(3))
    });
    chart.draw_series(bars)?;
    match kind {
        Kind::Line => {
            chart.draw_series(std::iter::once(PathElement::new(path, line)))?;
        }
        Kind::Analytic => {
            chart.draw_series(DashedLineSeries::new(path, 18, 12, line))?;
        }
        Kind::Points => {
            chart.draw_series(
                path.into_iter().map(|at| Circle::new(at, POINT_RADIUS, color.filled())),
            )?;
        }
        Kind::Source => {
            let hollow = color.stroke_width(3);
            chart.draw_series(
                path.into_iter().map(|at| Circle::new(at, POINT_RADIUS + 2, hollow)),
            )?;
        }
    }
    Ok(())
}

fn axes(plot: &Plot) -> (Axis, Axis) {
    let points = || plot.series.iter().flat_map(|series| &series.points);
    let heights = plot.series.iter().flat_map(|series| {
        let deviation = |i: usize| series.deviations.get(i).copied().unwrap_or(0.0);
        series.points.iter().enumerate().flat_map(move |(i, point)| {
            [point[1] - deviation(i), point[1], point[1] + deviation(i)]
        })
    });
    (Axis::around(points().map(|point| point[0]), plot.log_x), Axis::around(heights, plot.log_y))
}

/// The points that can be shown.
fn visible(series: &Series, x: &Axis, y: &Axis) -> Vec<Dot> {
    let dot = |(i, point): (usize, &[f64; 2])| {
        ((point[0], point[1]), series.deviations.get(i).copied().unwrap_or(0.0))
    };
    let is_visible = |it: &Dot| x.can_show(it.0.0) && y.can_show(it.0.1);
    series.points.iter().enumerate().map(dot).filter(is_visible).collect()
}

fn rgb(hex: &str) -> RGBColor {
    let part = |at: usize| u8::from_str_radix(&hex[at..at + 2], 16).unwrap_or(0);
    RGBColor(part(1), part(3), part(5))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(kind: Kind, points: Vec<[f64; 2]>) -> Series {
        let deviations = vec![0.1; points.len()];
        Series { label: "a & b".to_owned(), kind, points, deviations }
    }

    fn plot(series: Vec<Series>, log: bool) -> Plot {
        let text = str::to_owned;
        Plot {
            title: text("title"),
            source_says: text("nothing"),
            x_label: text("x < y [1]"),
            y_label: text("y [N]"),
            log_x: log,
            log_y: log,
            series,
        }
    }

    /// Oracle: the appearance of each kind; points that cannot be shown are left out.
    #[test]
    fn every_kind_is_drawn_and_invalid_points_are_left_out() {
        let points = vec![[1.0, 1.0], [10.0, 20.0], [f64::NAN, 3.0], [5.0, f64::INFINITY]];
        for log in [false, true] {
            let count = |kind: Kind, what: &str| {
                let plot = plot(vec![series(kind, points.clone())], log);
                let text = svg(&plot);
                assert!(text.contains("x &lt; y [1]") && !text.contains("NaN"), "{text}");
                text.matches(what).count() - svg(&self::plot(vec![], log)).matches(what).count()
            };
            assert_eq!(count(Kind::Points, "<circle"), 2);
            assert_eq!(count(Kind::Source, "fill=\"none\" stroke=\"#333A44\""), 2);
            assert!(10 < count(Kind::Analytic, "stroke=\"#333A44\""));
            // Two bars and one line.
            assert_eq!(count(Kind::Line, "stroke=\"#0072B2\""), 3);
        }
        drop(svg(&plot(vec![], true)));
        drop(svg(&plot(vec![series(Kind::Line, vec![[-1.0, 0.0]])], true)));
    }

    /// Oracle: the extremes of the input points.
    #[test]
    fn a_thinned_line_keeps_its_extremes() {
        let n = 100_000;
        let mut points: Vec<[f64; 2]> =
            (0..n).map(f64::from).map(|x| [x, (x * 0.01).sin()]).collect();
        points[77_777][1] = 9.0;
        let kept = &reduced(plot(vec![series(Kind::Line, points)], false)).series[0];
        assert!(kept.points.len() <= N_POINTS_MAX + 2);
        assert_eq!(kept.points.len(), kept.deviations.len());
        assert!(kept.points.iter().any(|point| 8.9 < point[1]));
        assert!(kept.points.windows(2).all(|pair| pair[0][0] < pair[1][0]), "left to right");
    }

    /// Oracle: the rule, applied by hand.
    #[test]
    fn references_share_the_colors_of_their_series() {
        let colors = |kinds: &[Kind]| {
            colors(&plot(kinds.iter().map(|kind| series(*kind, vec![])).collect(), false))
        };
        let palette = COLORS.map(|it| it.0);
        let [a, b, c, ..] = palette;
        assert_eq!(colors(&[Kind::Line, Kind::Points, Kind::Analytic]), [a, b, NEUTRAL_COLOR]);
        assert_eq!(colors(&[Kind::Line, Kind::Source, Kind::Line, Kind::Source]), [a, a, b, b]);
        assert_eq!(colors(&[Kind::Line, Kind::Analytic, Kind::Analytic]), [a, b, c]);
    }
}
