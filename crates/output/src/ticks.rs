//! Where the ticks of an axis go and what they say.

/// A tick counts as inside the axis if it is outside by less than this fraction of the step.
const EDGE_TOLERANCE: f64 = 1e-6;

/// Multiples of 1, 2 or 5 times a power of ten between `lo` and `hi`, about `target` of them, and their step.
pub(crate) fn linear_ticks(lo: f64, hi: f64, target: usize) -> (Vec<f64>, f64) {
    let span = hi - lo;
    let raw = span / target.max(1) as f64;
    let power = 10_f64.powf(raw.log10().floor());
    if !(span > 0.0 && power.is_normal()) {
        return (vec![lo], 0.0);
    }
    let mantissa = raw / power;
    let step =
        power * [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| mantissa <= m * (1.0 + 1e-9)).unwrap_or(10.0);
    (multiples(lo, hi, step), step)
}

/// The multiple of a power of ten, of 1, 2, 2.5 or 5, that divides a span into nearest to `count` parts.
pub(crate) fn step_for(span: f64, count: usize) -> f64 {
    let raw = span / count.max(1) as f64;
    let power = 10_f64.powf(raw.log10().floor());
    let distance = |m: &f64| (raw / (m * power)).ln().abs();
    let mantissas = [1.0, 2.0, 2.5, 5.0, 10.0];
    power * mantissas.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(1.0)
}

/// The multiples of `step` between `lo` and `hi`.
pub(crate) fn multiples(lo: f64, hi: f64, step: f64) -> Vec<f64> {
    let first = (lo / step - EDGE_TOLERANCE).ceil();
    let last = (hi / step + EDGE_TOLERANCE).floor();
    let count = (last - first).clamp(-1.0, 1000.0);
    // Dividing by a whole number gives 0.3 where multiplying by 0.1 gives 0.30000000000000004.
    let inverse = 1.0 / step;
    let whole = inverse.is_finite() && (inverse - inverse.round()).abs() < 1e-9 * inverse;
    let tick = |k: usize| {
        let n = first + k as f64;
        if step < 1.0 && whole { n / inverse.round() } else { n * step }
    };
    (0..(count + 1.0) as usize).map(tick).collect()
}

/// What is written at the ticks of a linear axis, and the factor that they have in common.
pub(crate) struct Labels {
    pub(crate) texts: Vec<String>,
    /// `×10⁻⁷`, to be written once beside the axis; empty if the numbers are of ordinary size.
    pub(crate) factor: String,
}

/// Labels of ticks that lie `step` apart, with the decimals that they need. Very large and very small numbers are
/// written without their power of ten, which is the common factor.
pub(crate) fn labels(ticks: &[f64], step: f64) -> Labels {
    let largest = ticks.iter().fold(step.abs(), |m, t| m.max(t.abs()));
    if largest == 0.0 || (1e-3..1e5).contains(&largest) {
        return Labels { texts: ticks.iter().map(|&t| plain(t, step)).collect(), factor: String::new() };
    }
    let exponent = largest.log10().floor() as i32;
    let scale = 10_f64.powi(exponent);
    let texts = ticks.iter().map(|&t| plain(t / scale, step / scale)).collect();
    Labels { texts, factor: format!("×{}", power_of_ten(exponent)) }
}

/// A single number with up to four digits.
pub(crate) fn label(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) {
        return plain(value, 0.0);
    }
    let exponent = value.abs().log10().floor() as i32;
    format!("{}×{}", plain(value / 10_f64.powi(exponent), 0.0), power_of_ten(exponent))
}

/// A number with as many decimals as a step needs, or four digits if there is no step, and a real minus sign.
fn plain(value: f64, step: f64) -> String {
    if value == 0.0 || value.abs() < 1e-9 * step {
        return "0".to_owned();
    }
    if step <= 0.0 {
        let decimals = (3.0 - value.abs().log10().floor()).clamp(0.0, 15.0) as usize;
        let digits = format!("{value:.decimals$}");
        let short = if decimals > 0 { digits.trim_end_matches('0').trim_end_matches('.') } else { &digits };
        return minus(short);
    }
    let mut decimals = (-step.log10().floor()).clamp(0.0, 15.0) as usize;
    // A step of 0.25 needs one digit more than its magnitude says.
    let digits = step * 10_f64.powi(decimals as i32);
    if (digits - digits.round()).abs() > 1e-6 {
        decimals += 1;
    }
    minus(&format!("{value:.decimals$}"))
}

/// `10` to a power.
pub(crate) fn power_of_ten(exponent: i32) -> String {
    format!("10{}", superscript(exponent))
}

fn superscript(exponent: i32) -> String {
    exponent
        .to_string()
        .chars()
        .map(|digit| match digit {
            '-' => '⁻',
            '0' => '⁰',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            other => char::from_u32('⁰' as u32 + other as u32 - '0' as u32).unwrap_or(other),
        })
        .collect()
}

/// The number with a minus sign instead of a hyphen.
pub(crate) fn minus(number: &str) -> String {
    number.replace('-', "−")
}

/// Ticks of a logarithmic axis in powers of ten from `lo` to `hi` (decimal logarithms): where labels go, with their
/// text, and the finer ticks between.
pub(crate) struct LogTicks {
    pub(crate) labelled: Vec<(f64, String)>,
    pub(crate) minor: Vec<f64>,
}

/// Decades, every second or third of them if there are many, or 1, 2 and 5 within a decade or two.
pub(crate) fn log_ticks(lo: f64, hi: f64, target: usize) -> LogTicks {
    let edge = EDGE_TOLERANCE * (hi - lo);
    let inside = |t: &f64| *t >= lo - edge && *t <= hi + edge;
    let (first, last) = (lo.floor() as i32, hi.ceil() as i32);
    let full_decades = (hi + edge).floor() - (lo - edge).ceil();
    let mut minor: Vec<f64> = Vec::new();
    if full_decades < 2.0 {
        let mantissas: &[u32] = if hi - lo > 1.3 { &[1, 2, 5] } else { &[1, 2, 3, 5] };
        let every = |decade: i32, m: u32| (f64::from(decade) + f64::from(m).log10(), simple(m, decade));
        let labelled = (first..=last).flat_map(|d| mantissas.iter().map(move |&m| every(d, m)));
        minor.extend((first..=last).flat_map(|d| (2..10).map(move |m| f64::from(d) + f64::from(m).log10())));
        return LogTicks {
            labelled: labelled.filter(|(t, _)| inside(t)).collect(),
            minor: minor.into_iter().filter(inside).collect(),
        };
    }
    let stride = (full_decades / target.max(1) as f64).ceil().max(1.0) as i32;
    let labelled = (first..=last)
        .filter(|d| d.rem_euclid(stride) == 0)
        .map(|d| (f64::from(d), power_of_ten(d)))
        .filter(|(t, _)| inside(t))
        .collect();
    if stride == 1 {
        minor.extend((first..=last).flat_map(|d| (2..10).map(move |m| f64::from(d) + f64::from(m).log10())));
    } else {
        minor.extend((first..=last).map(f64::from));
    }
    LogTicks { labelled, minor: minor.into_iter().filter(inside).collect() }
}

/// `mantissa` times ten to `exponent`, written as simply as can be.
fn simple(mantissa: u32, exponent: i32) -> String {
    match (mantissa, exponent) {
        (_, -3..0) => {
            format!("{:.*}", exponent.unsigned_abs() as usize, f64::from(mantissa) * 10_f64.powi(exponent))
        }
        (_, 0..5) => format!("{}", f64::from(mantissa) * 10_f64.powi(exponent)),
        (1, _) => power_of_ten(exponent),
        _ => format!("{mantissa}×{}", power_of_ten(exponent)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_one_two_or_five() {
        let (ticks, step) = linear_ticks(0.0, 1.0, 5);
        assert_eq!(step, 0.2);
        assert_eq!(ticks, [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]);
        assert_eq!(linear_ticks(-3.0, 17.0, 5).0, [0.0, 5.0, 10.0, 15.0]);
        assert_eq!(linear_ticks(2.0, 2.0, 5).0, [2.0]);
        assert_eq!(linear_ticks(0.0, 3e-7, 3).0.len(), 4);
    }

    #[test]
    fn bands_come_near_the_number_asked_for() {
        assert_eq!(step_for(4.5, 14), 0.25);
        assert_eq!(step_for(1.0, 10), 0.1);
        assert_eq!(multiples(-0.1, 0.8, 0.25), [0.0, 0.25, 0.5, 0.75]);
        assert!(multiples(0.3, 0.4, 0.25).is_empty());
    }

    #[test]
    fn labels_are_short() {
        let texts = |ticks: &[f64], step| labels(ticks, step).texts;
        assert_eq!(texts(&[0.30000000000000004, 1e-20, -2.0], 0.1), ["0.3", "0", "−2.0"]);
        assert_eq!(texts(&[-0.25, 0.0], 0.25), ["−0.25", "0"]);
        assert_eq!(texts(&[1500.0], 500.0), ["1500"]);
        let small = labels(&[2.0e-7, 2.5e-7], 5e-8);
        assert_eq!((small.texts, small.factor.as_str()), (vec!["2.0".into(), "2.5".into()], "×10⁻⁷"));
        assert_eq!([3.0, -0.125, 3e10, 1.23456e-5].map(label), ["3", "−0.125", "3×10¹⁰", "1.235×10⁻⁵"]);
    }

    #[test]
    fn decades_are_labelled_sparsely() {
        let ticks = log_ticks(-12.2, 1.3, 7);
        let names: Vec<_> = ticks.labelled.iter().map(|t| t.1.as_str()).collect();
        assert_eq!(names, ["10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²", "10⁰"]);
        let within = log_ticks(-1.65, -0.68, 7);
        let names: Vec<_> = within.labelled.iter().map(|t| t.1.as_str()).collect();
        assert_eq!(names, ["0.03", "0.05", "0.1", "0.2"]);
    }
}
