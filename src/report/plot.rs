//! Pictures as SVG: measured lines and points with their deviations, analytic references dashed,
//! the source's points hollow.
//!
//! Colours are written as attributes; the style of the page replaces them where it is dark.

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

/// Picture elements across and down; pages scale them.
const SIZE: (u32, u32) = (1440, 840);
/// Colours of the series, told apart also by those who see no red or no green (Okabe & Ito 2008,
/// the yellow darker), and what takes their place where the page is dark.
const COLOURS: [(&str, &str); 8] = [
    ("#0072B2", "#5BB4F0"),
    ("#D55E00", "#FF9352"),
    ("#009E73", "#3ED6A8"),
    ("#CC79A7", "#EBA4CB"),
    ("#B8860B", "#E5BC4D"),
    ("#56B4E9", "#A9DCFA"),
    ("#6A3D9A", "#B99AE0"),
    ("#7F4F24", "#C99B6D"),
];
/// The colours of ink and grid where the page is dark.
const DARK: [(&str, &str); 2] = [("#333A44", "#C3CBD4"), ("#E3E6EA", "#313943")];
/// The colour of a series that belongs to all others.
const NEUTRAL: &str = "#333A44";
/// Axes and their numbers.
const INK: RGBColor = RGBColor(0x33, 0x3a, 0x44);
/// Lines of the grid.
const GRID: RGBColor = RGBColor(0xe3, 0xe6, 0xea);
/// Width of a line.
const LINE: u32 = 4;
/// Radius of a point.
const POINT: u32 = 7;
/// Height of a line of the legend.
const LEGEND_LINE: u32 = 48;
/// Where the legend begins, from the left.
const LEGEND_LEFT: u32 = 40;
/// Room for the drawing before a label.
const LEGEND_SWATCH: u32 = 76;
/// Width of a letter, about.
const LETTER: u32 = 17;
/// Points of a line beyond which the picture would only grow, not get better.
const N_POINTS_MAX: usize = 500;

type Fault<'a> =
    DrawingAreaErrorKind<<SVGBackend<'a> as plotters::prelude::DrawingBackend>::ErrorType>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

/// The picture as an `<svg>` element of a page that has the legend and the colours of paper.
pub fn svg(plot: &Plot) -> String {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        draw(plot, &area).expect("memory is the only limit");
        area.present().expect("memory is the only limit");
    }
    // As wide as the page allows, not as wide as its own picture elements.
    text.replacen(&format!("width=\"{}\" height=\"{}\" ", SIZE.0, SIZE.1), "", 1)
}

/// The picture as a file of its own: on white, with its legend above.
pub fn picture(plot: &Plot) -> String {
    let places = legend_places(plot);
    let n_lines = places.last().map_or(0, |place| place.1 + 1);
    let height = 20 + LEGEND_LINE * n_lines;
    let mut text = String::new();
    {
        let size = (SIZE.0, SIZE.1 + height);
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        area.fill(&WHITE).expect("memory is the only limit");
        let (legend, rest) = area.split_vertically(height);
        draw_legend(plot, &places, &legend).expect("memory is the only limit");
        draw(plot, &rest).expect("memory is the only limit");
        area.present().expect("memory is the only limit");
    }
    text
}

/// Where the labels of the series begin: from the left, and in which line.
fn legend_places(plot: &Plot) -> Vec<(u32, u32)> {
    let (mut x, mut line) = (LEGEND_LEFT, 0);
    let mut places = Vec::new();
    for series in &plot.series {
        let n = u32::try_from(series.label.chars().count()).unwrap_or(0);
        let width = LEGEND_SWATCH + LETTER * n + 50;
        if SIZE.0 < x + width && LEGEND_LEFT < x {
            (x, line) = (LEGEND_LEFT, line + 1);
        }
        places.push((x, line));
        x += width;
    }
    places
}

fn draw_legend<'b>(
    plot: &Plot,
    places: &[(u32, u32)],
    area: &DrawingArea<SVGBackend<'b>, Shift>,
) -> Result<(), Fault<'b>> {
    let pixel = |it: u32| i32::try_from(it).unwrap_or(i32::MAX);
    let label = TextStyle::from(("sans-serif", 37)).color(&INK);
    let label = label.pos(Pos::new(HPos::Left, VPos::Center));
    for ((series, colour), (x, line)) in plot.series.iter().zip(colours(plot)).zip(places) {
        let (colour, x, y) = (rgb(colour), pixel(*x), pixel(20 + LEGEND_LINE * line + 30));
        let (end, middle) = (x + 60, (x + 30, y));
        let stroke = colour.stroke_width(LINE);
        match series.kind {
            Kind::Line => area.draw(&PathElement::new([(x, y), (end, y)], stroke))?,
            Kind::Analytic => {
                for from in [x, x + 24, x + 48] {
                    area.draw(&PathElement::new([(from, y), (from + 14, y)], stroke))?;
                }
            }
            Kind::Points => area.draw(&Circle::new(middle, POINT + 1, colour.filled()))?,
            Kind::Source => area.draw(&Circle::new(middle, POINT + 2, colour.stroke_width(3)))?,
        }
        area.draw(&Text::new(series.label.as_str(), (x + pixel(LEGEND_SWATCH), y), label.clone()))?;
    }
    Ok(())
}

/// The colours of a plot's series. References and source points that are as many as the measured
/// curves share their colours, one by one; a single one belongs to all.
pub fn colours(plot: &Plot) -> Vec<&'static str> {
    let is_measured = |kind: Kind| matches!(kind, Kind::Line | Kind::Points);
    let count = |is: &dyn Fn(Kind) -> bool| plot.series.iter().filter(|it| is(it.kind)).count();
    let n_measured = count(&is_measured);
    let mut n_others = n_measured;
    let mut seen = Vec::new();
    let mut colours = Vec::new();
    for kind in plot.series.iter().map(|series| series.kind) {
        let same = |it: &Kind| *it == kind || is_measured(*it) && is_measured(kind);
        let k = seen.iter().filter(|it| same(it)).count();
        let n = if is_measured(kind) { n_measured } else { count(&|it| it == kind) };
        colours.push(if n == n_measured {
            COLOURS[k % COLOURS.len()].0
        } else if n == 1 {
            NEUTRAL
        } else {
            n_others += 1;
            COLOURS[(n_others - 1) % COLOURS.len()].0
        });
        seen.push(kind);
    }
    colours
}

/// What takes the place of each colour where the page is dark.
pub fn dark() -> impl Iterator<Item = (&'static str, &'static str)> {
    COLOURS.into_iter().chain(DARK)
}

/// A picture's numbers as they can be seen: long lines thinned, six digits. The curves keep all.
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

/// Of every short stretch the lowest and the highest point.
fn extremes(points: &[[f64; 2]]) -> Vec<usize> {
    let stretch = points.len().div_ceil(N_POINTS_MAX / 2);
    let mut kept = Vec::new();
    for start in (0..points.len()).step_by(stretch) {
        let here = start..points.len().min(start + stretch);
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

fn draw<'b>(plot: &Plot, area: &DrawingArea<SVGBackend<'b>, Shift>) -> Result<(), Fault<'b>> {
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
    for (series, colour) in plot.series.iter().zip(colours(plot)) {
        draw_series(&mut chart, series.kind, rgb(colour), &visible(series, &x, &y), y.lowest())?;
    }
    Ok(())
}

/// A point and the deviation of its height.
type Dot = ((f64, f64), f64);

fn draw_series<'b>(
    chart: &mut Chart<'_, 'b>,
    kind: Kind,
    colour: RGBColor,
    dots: &[Dot],
    lowest: f64,
) -> Result<(), Fault<'b>> {
    let line = colour.stroke_width(LINE);
    let path: Vec<(f64, f64)> = dots.iter().map(|dot| dot.0).collect();
    let bars = dots.iter().filter(|dot| 0.0 < dot.1).map(|&((x, y), deviation)| {
        let ends = vec![(x, (y - deviation).max(lowest)), (x, y + deviation)];
        PathElement::new(ends, colour.stroke_width(3))
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
            chart
                .draw_series(path.into_iter().map(|at| Circle::new(at, POINT, colour.filled())))?;
        }
        Kind::Source => {
            let hollow = colour.stroke_width(3);
            chart.draw_series(path.into_iter().map(|at| Circle::new(at, POINT + 2, hollow)))?;
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
    let is_visible = |it: &Dot| x.shows(it.0.0) && y.shows(it.0.1);
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

    /// Oracle: what each kind looks like; what cannot be shown is left out.
    #[test]
    fn every_kind_has_its_own_look_and_nothing_breaks_a_picture() {
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

    /// Oracle: the extremes of the points themselves.
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

    /// Oracle: the rule, by hand.
    #[test]
    fn references_share_the_colours_of_what_they_belong_to() {
        let colours = |kinds: &[Kind]| {
            colours(&plot(kinds.iter().map(|kind| series(*kind, vec![])).collect(), false))
        };
        let palette = COLOURS.map(|it| it.0);
        let [a, b, c, ..] = palette;
        assert_eq!(colours(&[Kind::Line, Kind::Points, Kind::Analytic]), [a, b, NEUTRAL]);
        assert_eq!(colours(&[Kind::Line, Kind::Source, Kind::Line, Kind::Source]), [a, a, b, b]);
        assert_eq!(colours(&[Kind::Line, Kind::Analytic, Kind::Analytic]), [a, b, c]);
    }
}
