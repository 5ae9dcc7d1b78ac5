"""NAFEMS T3 by its series: a bar of 0.1 m, at 0 on one end and at 100 sin(pi t / 40) on the other, cold at first.

u = g(t) x / L + sum b_n(t) sin(n pi x / L), b_n' + lambda_n b_n = -g'(t) c_n with x / L = sum c_n sin(n pi x / L).
Needs mpmath. Prints the value at x = 0.08 m and t = 32 s for growing numbers of terms: the series converges slowly. The
36.6004964 that is found elsewhere is not its sum.
"""

from mpmath import cos, exp, mp, mpf, nstr, pi, sin

mp.dps = 25
LENGTH, CONDUCTIVITY, CAPACITY = mpf("0.1"), mpf(35), mpf(7200) * mpf("440.5")
OMEGA, TIME, PLACE = pi / 40, mpf(32), mpf("0.08")


def term(n):
    decay = CONDUCTIVITY / CAPACITY * (n * pi / LENGTH) ** 2
    share = 2 * (-1) ** (n + 1) / (n * pi)
    swing = decay * cos(OMEGA * TIME) + OMEGA * sin(OMEGA * TIME) - decay * exp(-decay * TIME)
    return -share * 100 * OMEGA * swing / (decay**2 + OMEGA**2) * sin(n * pi * PLACE / LENGTH)


value, terms = 100 * sin(OMEGA * TIME) * PLACE / LENGTH, 0
for limit in [10, 80, 100, 1000, 10000, 20000]:
    while terms < limit:
        terms += 1
        value += term(terms)
    print(limit, nstr(value, 12))
