"""Reference values of the kernels, written to kernels.csv: `python3 kernels.py > kernels.csv` (needs mpmath).

60 digits while computing, 30 written, sigma = 1. The Gaussian kernels come from their definition: with
zeta_m^(k) = exp(-k^2/2) sum_{j < m/2} (k^2/2)^j / j! and -lap G_2 = zeta_2,
    G_m = G_2 + sum_{0 < j < m/2} (1/2)^j / j! (-lap)^(j-1) zeta_2,
the Laplacians of p(x) exp(-x), x = r^2/2, being taken on rational polynomials. That is another way than the Laguerre
recurrence of the crate; a few values were compared with the inverse Fourier integral by quadrature as well (`check`).
"""
import sys
from fractions import Fraction as F
from mpmath import mp, mpf, sqrt, pi, exp, log, erf, e1, si, euler, quad, besselj, cos, sin, inf, hyp2f3, expint

mp.dps = 60


def laplacian(p, d):
    """Coefficients of q with lap(p e^-x) = q e^-x, x = r^2/2, in d dimensions: lap = d f' + 2 x f''."""
    def diff(q):
        return [c * i for i, c in enumerate(q)][1:] or [F(0)]

    def minus(a, b):
        n = max(len(a), len(b))
        return [(a[i] if i < len(a) else 0) - (b[i] if i < len(b) else 0) for i in range(n)]
    first = minus(diff(p), p)
    second = minus(diff(first), first)
    q = [F(0)] * (len(p) + 1)
    for i, c in enumerate(first):
        q[i] += d * c
    for i, c in enumerate(second):
        q[i + 1] += 2 * c
    return q


def ein(x):
    """The entire part of E1: sum (-1)^(k+1) x^k / (k k!)."""
    if x < 40:
        with mp.extradps(40):
            s, t, k = mpf(0), mpf(1), 0
            while True:
                k += 1
                t = -t * x / k
                s -= t / k
                if abs(t) < mpf(10) ** -100:
                    return s
    return e1(x) + log(x) + euler


def g2(d, r):
    x = r * r / 2
    if d == 1:
        return -(r * erf(r / sqrt(2)) + sqrt(2 / pi) * exp(-x)) / 2
    if d == 2:
        return -((log(2) - euler + ein(x)) / 2) / (2 * pi)
    return sqrt(2 / pi) / (4 * pi) if r == 0 else erf(r / sqrt(2)) / (4 * pi * r)


def gaussian(d, m, r):
    x = r * r / 2
    zeta = (2 * pi) ** (-mpf(d) / 2)
    total, p, scale = g2(d, r), [F(1)], F(1)
    for j in range(1, m // 2):
        scale = scale / (2 * j)
        total += zeta * exp(-x) * sum(mpf(c.numerator) / c.denominator * x ** i for i, c in enumerate(p)) * scale.numerator / scale.denominator
        p = [-c for c in laplacian(p, d)]
    return total


def spectral(d, r):
    if d == 1:
        return -(r * si(r) + cos(r)) / pi
    if d == 2:
        # int_0^r (1 - J0(u))/u du as a hypergeometric function
        with mp.extradps(int(r) + 20):
            integral = r * r / 8 * hyp2f3(1, 1, 2, 2, 2, -r * r / 4)
        return -(integral + log(2) - euler) / (2 * pi)
    return 1 / (2 * pi ** 2) if r == 0 else si(r) / (2 * pi ** 2 * r)


def truncated(d, k, l):
    """The transform of the singular kernel within the radius l: int_0^l G(r) cos(kr) 2 dr, G(r) J0(kr) 2 pi r dr, G(r) sin(kr)/(kr) 4 pi r^2 dr."""
    if k == 0:
        return {1: -l * l / 2, 2: l * l * (1 - 2 * log(l)) / 4, 3: l * l / 2}[d]
    if d == 1:
        return (1 - cos(l * k)) / k ** 2 - l * sin(l * k) / k
    if d == 2:
        return (1 - besselj(0, l * k)) / k ** 2 - l * log(l) * besselj(1, l * k) / k
    return 2 * (sin(l * k / 2) / k) ** 2


def check():
    l, k = mpf(2), mpf(3)
    by_quadrature = {
        1: quad(lambda r: -r * cos(k * r), [0, l]),
        2: quad(lambda r: -log(r) * besselj(0, k * r) * r, [0, 1, l]),
        3: quad(lambda r: sin(k * r) / k, [0, l]),
    }
    for d, v in by_quadrature.items():
        print("truncated", d, mp.nstr(v - truncated(d, k, l), 5), file=sys.stderr)

    for d, m in [(3, 6), (3, 20), (2, 8)]:
        r = mpf(3) / 2
        def zhat(k): return exp(-k * k / 2) * sum((k * k / 2) ** j / mp.factorial(j) for j in range(m // 2))
        if d == 3:
            v = quad(lambda k: zhat(k) * sin(k * r) / (k * r), range(0, 40)) / (2 * pi ** 2)
        else:
            s = mpf(2)
            v0 = quad(lambda k: zhat(k) * (besselj(0, k * r) - besselj(0, k * s)) / k, range(0, 40)) / (2 * pi)
            v = v0 + gaussian(d, m, s)
        print(d, m, mp.nstr(v - gaussian(d, m, r), 5), file=sys.stderr)


RADII = ["0", "1e-8", "1e-4", "0.01", "0.09375", "0.3125", "0.5", "0.875", "1", "1.25", "1.4375", "1.75", "2", "2.5", "3", "3.5", "4.25",
         "5", "6", "7", "8", "9", "10", "12.5", "15", "20", "30", "39.5", "40.5", "64", "100", "1000.5"]


def radius(text):
    return mpf(float(text))  # the double that a program reads


def show(x):
    return mp.nstr(x, 30, min_fixed=1, max_fixed=0)


if __name__ == "__main__":
    check()
    print("# Written by kernels.py. sigma = 1; the difference is G(r; 1) - G(r; 2), the band pass of ratio 2; of truncated kernels of radius 2, r is the wave number.")
    print("kernel,dimension,order,r,value")
    for d in (1, 2, 3):
        for m in range(2, 22, 2):
            for text in RADII:
                print(f"gaussian,{d},{m},{text},{show(gaussian(d, m, radius(text)))}")
    for d in (1, 2, 3):
        for text in RADII:
            print(f"spectral,{d},0,{text},{show(spectral(d, radius(text)))}")
    for d in (2, 3):
        for m in (2, 4, 10, 20):
            for text in RADII:
                r = radius(text)
                if r > 30:
                    continue
                with mp.extradps(250):
                    # G(r; a) = a^(2-d) G(r/a; 1), and -ln a / 2 pi in two dimensions
                    wide = gaussian(d, m, r / 2) / 2 if d == 3 else gaussian(d, m, r / 2) - log(2) / (2 * pi)
                    v = gaussian(d, m, r) - wide
                print(f"band-pass,{d},{m},{text},{show(v)}")
    for d in (1, 2, 3):
        for text in RADII:
            with mp.extradps(60):
                print(f"truncated,{d},0,{text},{show(truncated(d, radius(text), mpf(2)))}")
