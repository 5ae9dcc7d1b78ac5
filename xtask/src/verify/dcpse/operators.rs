//! Orders of DC-PSE operators on lattices and on clouds that are moved by a quarter and by half of the spacing.

use meshless_stencils::DcPse;

use crate::verify::claims::Claims;
use crate::verify::order;

/// Spacings at which a derivative is taken.
const SPACINGS: [f64; 3] = [0.08, 0.04, 0.02];

/// Points at which it is taken, each with a cloud of its own.
const POINTS: usize = 40;

/// By how much an order may fall short of what is asked for.
const SHORT_OF: f64 = 0.25;

/// What the coordinates of lattice points are moved by, in spacings.
const MOVES: [(f64, &str); 3] = [(0.0, "lattice"), (0.25, "±h/4"), (0.5, "±h/2")];

/// Numbers that are spread evenly over [-1, 1), always the same.
struct Scatter(u64);

impl Scatter {
    fn next(&mut self) -> f64 {
        // Splitmix64, the top 53 bits.
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (((z ^ (z >> 31)) >> 11) as f64) / (1_u64 << 52) as f64 - 1.0
    }
}

/// `sin(x_1 + 0.3) sin(1.3 x_2 + 0.3) ...` and any derivative of it.
fn function<const D: usize>(x: &[f64; D], orders: [u8; D]) -> f64 {
    (0..D)
        .map(|k| {
            let rate = 1.0 + 0.3 * k as f64;
            let phase = f64::from(orders[k]) * std::f64::consts::FRAC_PI_2;
            rate.powi(i32::from(orders[k])) * (rate * x[k] + 0.3 + phase).sin()
        })
        .product()
}

/// Root mean square of the error at all points, relative to that of the derivative; the operator has `count` neighbours.
fn error<const D: usize>(orders: [u8; D], order: usize, spacing: f64, movement: f64) -> Option<f64> {
    let operator = DcPse::<D>::derivative(orders, order);
    let count = operator.support();
    let mut scratch = operator.scratch(count);
    let mut random = Scatter(17 + order as u64);
    let (mut sum, mut size) = (0.0, 0.0);
    for _ in 0..POINTS {
        let home: [f64; D] = std::array::from_fn(|_| random.next());
        // Lattice points in a box that holds the ball of the nearest ones, whatever they are moved by.
        let reach = (count as f64).powf(1.0 / D as f64).ceil() as i32 / 2 + 2;
        let side = 2 * reach + 1;
        let mut moved = |s: f64| s + movement * random.next();
        let center: [f64; D] = std::array::from_fn(|_| moved(0.0));
        let mut offsets: Vec<[f64; D]> = (0..side.pow(D as u32))
            .map(|k| std::array::from_fn(|axis| k / side.pow(axis as u32) % side - reach))
            .filter(|index: &[i32; D]| index.iter().any(|&i| i != 0))
            .map(|index| std::array::from_fn(|k| spacing * (moved(f64::from(index[k])) - center[k])))
            .collect();
        let squared = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>();
        offsets.sort_by(|a, b| squared(a).total_cmp(&squared(b)));
        // A shell of the lattice is taken wholly.
        let radius = squared(&offsets[count.min(offsets.len()) - 1]).sqrt() * (1.0 + 1e-9);
        offsets.retain(|x| squared(x).sqrt() <= radius);
        let mut row = vec![0.0; offsets.len() + 1];
        operator.stencil(&offsets, 0.5 * radius, &mut scratch, &mut row).ok()?;
        let at = |offset: &[f64; D]| -> [f64; D] { std::array::from_fn(|k| home[k] + offset[k]) };
        let found = row[0] * function(&home, [0; D])
            + offsets.iter().zip(&row[1..]).map(|(x, c)| c * function(&at(x), [0; D])).sum::<f64>();
        let exact = function(&home, orders);
        sum += (found - exact).powi(2);
        size += exact * exact;
    }
    Some((sum / size).sqrt())
}

/// The least order of all derivatives in a list.
fn least<const D: usize>(derivatives: &[[u8; D]], order: usize, movement: f64) -> Option<f64> {
    let of = |orders: [u8; D]| {
        let ladder: Option<Vec<(f64, f64)>> =
            SPACINGS.iter().map(|&h| Some((h, error(orders, order, h, movement)?))).collect();
        order::fit(&ladder?)
    };
    derivatives.iter().map(|&orders| of(orders)).try_fold(f64::INFINITY, |least, q| Some(least.min(q?)))
}

pub(super) fn check(claims: &mut Claims) {
    for (movement, layout) in MOVES {
        for order in [2, 4] {
            let mut claim = |dimension: &str, measured: Option<f64>| {
                let text = format!(
                    "{dimension}, {layout}: least order of first and second derivatives, asked {order}"
                );
                claims.at_least("operators", text, measured, order as f64 - SHORT_OF);
            };
            claim("1-D", least(&[[1], [2]], order, movement));
            claim("2-D", least(&[[1, 0], [0, 1], [2, 0], [1, 1], [0, 2]], order, movement));
            let all = [
                [1, 0, 0],
                [0, 1, 0],
                [0, 0, 1],
                [2, 0, 0],
                [0, 2, 0],
                [0, 0, 2],
                [1, 1, 0],
                [1, 0, 1],
                [0, 1, 1],
            ];
            claim("3-D", least(&all, order, movement));
        }
        let text = format!("2-D, {layout}: least order of first and second derivatives, asked 6");
        let measured = least(&[[1, 0], [0, 1], [2, 0], [1, 1], [0, 2]], 6, movement);
        claims.at_least("operators", text, measured, 6.0 - SHORT_OF);
    }
}
