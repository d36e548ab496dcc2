"""Trim and eigenvalues of two airframes in 60 digits: python3 airframes.py. Needs mpmath."""

from mpmath import cos, diff, findroot, matrix, mp, mpf, pi, sin

mp.dps = 60


def numbers(text):
    return {name: mpf(value) for name, value in (pair.split("=") for pair in text.split())}


AEROSONDE = numbers(
    "m=13.5 J=1.135 S=0.55 b=2.8956 c=0.18994 rho=1.2682 L0=0.28 La=3.45 Lq=0 Le=-0.36 Dp=0.0437 e=0.9"
    " m0=-0.02338 ma=-0.38 mq=-3.6 me=-0.5 P=0.2027 k=80"
)
X8 = numbers(
    "m=3.364 J=0.1702 S=0.75 b=2.1 c=0.35714285714285715 rho=1.225 L0=0.08673556671610734 La=4.0203282440006793"
    " Lq=3.87 Le=0.27807362017347131 D0=0.01970001181915082 D1=0.079091463157662967 D2=1.0554699867680841"
    " De=0.063347396781802318 m0=0.02275 ma=-0.4629 mq=-1.3012370370370372 me=-0.2292 P=0.10178760197630929 k=40"
)
G = mpf("9.81")


def rates(p, a, q, v, theta, de, dt):
    pressure = p["rho"] * v**2 * p["S"] / 2
    turning = p["c"] * q / (2 * v)
    attached = p["L0"] + p["La"] * a
    lift = pressure * (attached + p["Lq"] * turning + p["Le"] * de)
    if "Dp" in p:
        drag = p["Dp"] + attached**2 / (pi * p["e"] * p["b"] ** 2 / p["S"])
    else:
        drag = p["D0"] + p["D1"] * a + p["D2"] * a**2 + p["De"] * de**2
    drag *= pressure
    thrust = p["rho"] * p["P"] * ((p["k"] * dt) ** 2 - v**2) / 2
    moment = pressure * p["c"] * (p["m0"] + p["ma"] * a + p["mq"] * turning + p["me"] * de)
    return (
        q - (lift + thrust * sin(a)) / (p["m"] * v) + G * cos(theta - a) / v,
        moment / p["J"],
        (thrust * cos(a) - drag) / p["m"] - G * sin(theta - a),
        q,
    )


def flight(name, p, speed, climb):
    def steady(a, de, dt):
        return rates(p, a, mpf(0), speed, a + climb, de, dt)[:3]

    a, de, dt = findroot(steady, (mpf("0.05"), mpf("0"), speed / p["k"] * mpf("1.2")))
    at = (a, mpf(0), speed, a + climb, de, dt)
    jacobian = matrix(4, 4)
    for row in range(4):
        for column in range(4):
            order = tuple(int(column == place) for place in range(6))
            jacobian[row, column] = diff(lambda *x: rates(p, *x)[row], at, order)
    values = sorted(mp.eig(jacobian)[0], key=lambda z: (z.real, z.imag))
    print(name, speed, *(mp.nstr(x, 20) for x in (a, de, dt)))
    print(*(f"[{mp.nstr(z.real, 20)}, {mp.nstr(z.imag, 20)}]" for z in values), sep="\n")


for airspeed in ("25", "35"):
    flight("Aerosonde", AEROSONDE, mpf(airspeed), mpf(0))
for airspeed in ("15", "18", "24"):
    flight("X8", X8, mpf(airspeed), mpf("0.05"))
