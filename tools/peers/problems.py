"""Problems that any rigid-body engine can be asked, each with its answer from a formula.

No engine takes part in the answers. A problem is a few cases: scenes that differ in where events fall between steps, so
that no step is lucky by chance. The error of a problem is the greatest over cases, bodies and sampled moments.

A scene is a dictionary:

    gravity    (x, y) in m/s2
    bodies     discs: at (m), velocity (m/s), spin (rad/s), radius (m), mass (kg), turns (False: cannot turn), angle (rad),
               inertia (kg m2; None: m r^2/2)
    material   friction and restitution of every contact of the scene (engines that combine two values get what gives these)
    floor      whether the half-plane y < 0 is solid
    drag       rate of linear drag in 1/s, all bodies
    spring     None, or stiffness (N/m) of a spring of 1 m between body 0 and the point (-1, 0); motion is along x
    joints     hinges: bodies a (None: the world) and b, their anchors from the centres (m), in the frames of the bodies; servo None,
               or target (rad), kp and kd of a torque kp (target - angle) - kd rate, of b less a. With joints nothing touches.
               A body comes as b before it comes as a; where it comes as b again, the hinge closes a loop

States are lists [x, y, angle, vx, vy, spin], one a body. Moments are multiples of 0.05 s: whole numbers of steps of 1/60 s.
"""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

GRAVITY = 9.81  # m/s2


@dataclass(frozen=True)
class Problem:
    name: str
    unit: str  # of the error
    law: str
    source: str
    samples: tuple[float, ...]  # s
    cases: list[dict]
    error: Callable[[dict, float, list], float]  # of a case, a time and the states of its bodies
    kind: str  # what happens: it decides which settings are tried


def disc(at, velocity=(0.0, 0.0), spin=0.0, radius=0.1, mass=1.0, turns=True, angle=0.0, inertia=None):
    body = {"at": at, "velocity": velocity, "spin": spin, "radius": radius, "mass": mass, "turns": turns}
    return body | {"angle": angle, "inertia": inertia}


def scene(bodies, gravity=(0.0, 0.0), friction=0.0, restitution=0.0, floor=False, drag=0.0, spring=None, joints=(), **truth):
    return {
        "bodies": bodies,
        "gravity": gravity,
        "material": {"friction": friction, "restitution": restitution},
        "floor": floor,
        "drag": drag,
        "spring": spring,
        "joints": list(joints),
        "truth": truth,  # what the formula needs to know; engines do not look at it
    }


# Flight


def free_flight(case, time, states):
    # x = x0 + v t + g t^2/2, angle = omega t: any textbook. The angle counts as the way of a point of the rim.
    x, y, angle, *_ = states[0]
    exact = (1 + 12 * time, 2 + 15 * time - 0.5 * GRAVITY * time**2)
    return max(math.dist((x, y), exact), 0.1 * abs(angle - 3 * time))


def constant_acceleration(case, time, states):
    # x = a t^2/2: Galilei, Discorsi, 1638.
    return math.dist(states[0][:2], (5 * time**2, 0))


DRAG = 0.25  # 1/s


def linear_drag(case, time, states):
    # v = u + (v0 - u) e^(-r t) with the terminal velocity u = g/r; its integral: any textbook (Stokes 1851).
    way = -math.expm1(-DRAG * time) / DRAG
    exact = (10 * way, -GRAVITY / DRAG * time + (20 + GRAVITY / DRAG) * way)
    return math.dist(states[0][:2], exact) / math.hypot(*exact)


def spring_mass(case, time, states):
    # x = x0 cos(w t) + v0/w sin(w t), w = sqrt(k/m): Hooke 1678. Over the amplitude.
    exact = 0.1 * math.cos(10 * time) + 0.05 * math.sin(10 * time)
    return abs(states[0][0] - exact) / math.hypot(0.1, 0.05)


# Impacts without friction


def bounced(height, restitution, time):
    """Gap under a ball let go at rest: parabolas, each impact multiplies the speed by the restitution (Newton)."""
    fall = math.sqrt(2 * height / GRAVITY)
    if time <= fall:
        return height - 0.5 * GRAVITY * time**2
    time, speed = time - fall, GRAVITY * fall * restitution
    # The flights after impacts are shorter by the restitution each; where it is below 1 they end after a finite time.
    if restitution < 1 and time >= 2 * speed / GRAVITY / (1 - restitution):
        return 0.0
    while time > 2 * speed / GRAVITY:
        time, speed = time - 2 * speed / GRAVITY, speed * restitution
    return speed * time - 0.5 * GRAVITY * time**2


def bounce_error(case, time, states):
    height, restitution = case["truth"]["height"], case["material"]["restitution"]
    return abs(states[0][1] - 0.1 - bounced(height, restitution, time)) / height


def bounces(restitution, heights):
    fall = {"gravity": (0.0, -GRAVITY), "restitution": restitution, "floor": True}
    return [scene([disc((0.0, 0.1 + height))], height=height, **fall) for height in heights]


def inelastic_impact(case, time, states):
    # At the speed v to the wall, at e v away from it (Newton's law of impact). Over the speed times a second.
    gap, since = case["truth"]["gap"], time - case["truth"]["gap"] / 2
    exact = -2 * since if since < 0 else 0.6 * 2 * since
    return abs(states[0][1] - 0.1 - exact) / 2


# Impacts with friction

FRICTION = 0.3
RESTITUTION = 0.7


def struck(bodies, normal, first, second=None):
    """Velocities and spins after an impact with Coulomb friction: Walton 1993; Foerster et al., Physics of Fluids 6, 1994.

    The impulse along the normal is (1 + e) times what stops the approach; that along the surface is what stops the slip,
    but at most mu times the other. `normal` points from the first to the second; without a second it is a wall.
    """
    nx, ny = normal
    tx, ty = -ny, nx
    still = {"velocity": (0.0, 0.0), "spin": 0.0, "radius": 0.0, "mass": math.inf}
    a, b = bodies[first], still if second is None else bodies[second]
    relative = [p - q for p, q in zip(a["velocity"], b["velocity"], strict=True)]
    approach = relative[0] * nx + relative[1] * ny
    slip = relative[0] * tx + relative[1] * ty + a["spin"] * a["radius"] + b["spin"] * b["radius"]
    inverse = 1 / a["mass"] + 1 / b["mass"]
    # A disc has the inertia m r^2/2: what moves its rim is 1/m + r^2/I = 3/m.
    normal_impulse = (1 + RESTITUTION) * approach / inverse
    along = -math.copysign(min(FRICTION * normal_impulse, abs(slip) / (3 * inverse)), slip)
    found = []
    for body, sign in ((a, 1), (b, -1)):
        if body is still:
            continue
        px, py = (sign * (along * t - normal_impulse * n) for t, n in ((tx, nx), (ty, ny)))
        vx, vy = body["velocity"]
        # On both the lever turns the same way: opposite forces at opposite sides.
        spin = body["spin"] + along * 2 / (body["mass"] * body["radius"])
        found.append((vx + px / body["mass"], vy + py / body["mass"], spin))
    return found


IMPACT = 0.37  # s, when the discs meet


def oblique_error(case, time, states):
    """Of places, over the way of a second, and of the velocities of centres and rims, over the speed before."""
    errors = []
    for body, state, (vx, vy, spin) in zip(case["bodies"], states, case["truth"]["after"], strict=True):
        place = [p + IMPACT * u + (time - IMPACT) * v for p, u, v in zip(body["at"], body["velocity"], (vx, vy), strict=True)]
        errors += [math.dist(state[:2], place), math.dist(state[3:5], (vx, vy)), body["radius"] * abs(state[5] - spin)]
    return max(errors) / 3


def oblique_collisions():
    rules = {"friction": FRICTION, "restitution": RESTITUTION}
    cases = []
    for degrees in (10, 30, 45, 60, 80):
        sin, cos = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
        bodies = [disc((0.0, 0.1 + IMPACT * 3 * cos), velocity=(3 * sin, -3 * cos))]
        cases.append(scene(bodies, floor=True, after=struck(bodies, (0, -1), 0), **rules))
    for degrees, spins in ((20, (0, 0)), (60, (0, 0)), (40, (15, -5))):
        # The first arrives along x; the line of centres points down to the right.
        normal = (math.cos(math.radians(degrees)), -math.sin(math.radians(degrees)))
        first = (-0.25 * normal[0] - IMPACT * 3, -0.25 * normal[1])
        bodies = [
            disc(first, velocity=(3.0, 0.0), spin=float(spins[0])),
            disc((0.0, 0.0), spin=float(spins[1]), radius=0.15, mass=2.0),
        ]
        cases.append(scene(bodies, after=struck(bodies, normal, 0, 1), **rules))
    return cases


# Newton's cradle: equal discs in a row, the first comes in at 1 m/s


def chain(count):
    """Velocities after a pulse through touching discs: equal linear springs that do not pull, as in Herrmann and Seitz,
    Am. J. Phys. 50, 1982. They do not depend on the stiffness: this is the limit of stiff elastic contacts.

    Between touching and parting the row is linear; its Taylor series is summed to the last bit, and the moments at which
    a contact parts or begins are bisected."""
    place, speed = [0.0] * count, [1.0] + [0.0] * (count - 1)

    def overlaps(place):
        return [place[i] - place[i + 1] for i in range(count - 1)]

    def after(place, speed, active, span):
        series, power = (list(place), list(speed)), (list(place), list(speed))
        for term in range(1, 40):
            u, v = power
            forces = [o if on else 0.0 for o, on in zip(overlaps(u), active)]
            pushes = [(forces[i - 1] if i else 0.0) - (forces[i] if i < count - 1 else 0.0) for i in range(count)]
            power = ([x * span / term for x in v], [x * span / term for x in pushes])
            series = tuple([s + p for s, p in zip(ss, pp)] for ss, pp in zip(series, power))
        return series

    time, active = 0.0, [True] * (count - 1)  # all touch
    while time < 40:
        span = 0.05
        changes = lambda to: any((o < -1e-15) == on for o, on in zip(overlaps(to), active))
        reached = after(place, speed, active, span)
        if changes(reached[0]):
            low, high = 0.0, span
            while high - low > 1e-15:
                middle = (low + high) / 2
                low, high = (low, middle) if changes(after(place, speed, active, middle)[0]) else (middle, high)
            span = high
            reached = after(place, speed, active, span)
            active = [o >= -1e-15 for o in overlaps(reached[0])]
        place, speed, time = *reached, time + span
    return speed


def cradle_error(case, time, states):
    """Of velocities over the speed before, and of places over the way of a second."""
    pairs = zip(states, case["truth"]["after"], case["truth"]["from"], strict=True)
    return max(max(abs(state[3] - speed), abs(state[0] - place - speed * time)) for state, speed, place in pairs)


def cradle(gap, after, starts):
    """The first comes from `start` away from where it would touch, were there no gaps."""
    cases = []
    for start in starts:
        places = [-start] + [i * (1.0 + gap) for i in range(1, 5)]
        bodies = [disc((x, 0.0), radius=0.5) for x in places]
        bodies[0]["velocity"] = (1.0, 0.0)
        # Where discs touch they leave from there at `start`; with gaps each is stopped where the next stood, and the last
        # leaves after all gaps.
        left = [start + (4 * gap if i == 4 else 0.0) for i in range(5)]
        stood = [i * (1.0 + gap) + (gap if i < 4 else 0.0) for i in range(5)]
        beginnings = [x - speed * t for x, speed, t in zip(stood, after, left, strict=True)]
        cases.append(scene(bodies, restitution=1.0, after=after, **{"from": beginnings}))
    return cases


# Dry friction

MU = 0.4


def sliding_stop(case, time, states):
    # v t - mu g t^2/2 until it stops at v/(mu g): Coulomb 1785.
    speed = case["bodies"][0]["velocity"][0]
    time = min(time, speed / (MU * GRAVITY))
    return abs(states[0][0] - (speed * time - 0.5 * MU * GRAVITY * time**2))


def slide_to_roll(case, time, states):
    # Friction mu m g slows the disc and turns it until the rim stands still on the floor, after v/(3 mu g): any textbook.
    speed = case["bodies"][0]["velocity"][0]
    slips = min(time, speed / (3 * MU * GRAVITY))
    rolls = time - slips
    way = speed * slips - 0.5 * MU * GRAVITY * slips**2 + 2 / 3 * speed * rolls
    turned = -MU * GRAVITY / 0.1 * slips**2 - 2 / 3 * speed / 0.1 * rolls
    return max(abs(states[0][0] - way), 0.1 * abs(states[0][2] - turned))


def incline(case, time, states):
    # Slides with g (sin a - mu cos a) if that is above zero; thrown uphill it slows by g (sin a + mu cos a): Coulomb 1785.
    angle, speed = math.radians(case["truth"]["degrees"]), case["bodies"][0]["velocity"][0]
    pull, friction = GRAVITY * math.sin(angle), MU * GRAVITY * math.cos(angle)
    turns = -speed / (pull + friction)
    rises = min(time, turns)
    falls = time - rises
    exact = speed * rises + 0.5 * (pull + friction) * rises**2 + 0.5 * max(pull - friction, 0) * falls**2
    return abs(states[0][0] - exact)


def on_floor(speed, turns, degrees=0.0):
    angle = math.radians(degrees)
    gravity = (GRAVITY * math.sin(angle), -GRAVITY * math.cos(angle))
    bodies = [disc((0.0, 0.1), velocity=(speed, 0.0), turns=turns)]
    return scene(bodies, gravity=gravity, friction=MU, floor=True, degrees=degrees)


# Joints

TRUTHS = Path(__file__).parent / "joints.json"  # written by joints_truth.py


def joint(a, anchor_a, b, anchor_b, servo=None):
    return {"a": a, "anchor_a": anchor_a, "b": b, "anchor_b": anchor_b, "servo": servo}


def hung(lengths, masses, angles, servos=()):
    """Uniform rods, each hung on the one above, the first in the origin: bodies, joints and the lowest end.

    Angles count from the downward vertical; at angle 0 the upper end of a rod is above its middle."""
    bodies, joints, x, y = [], [], 0.0, 0.0
    for place, (length, mass, angle) in enumerate(zip(lengths, masses, angles, strict=True)):
        along = (length * math.sin(angle), -length * math.cos(angle))
        middle = (x + along[0] / 2, y + along[1] / 2)
        bodies.append(disc(middle, mass=mass, angle=angle, inertia=mass * length**2 / 12))
        above = (place - 1, (0.0, -lengths[place - 1] / 2)) if place else (None, (0.0, 0.0))
        joints.append(joint(*above, place, (0.0, length / 2), servos[place] if servos else None))
        x, y = x + along[0], y + along[1]
    return bodies, joints, (x, y)


def mean(k):
    """Arithmetic-geometric mean of 1 and sqrt(1 - k^2), with the ratios (a - b)/(a + b) that lead to it."""
    a, b, ratios = 1.0, math.sqrt(1 - k * k), []
    while not ratios or ratios[-1] > 1e-17:
        a, b, ratios = (a + b) / 2, math.sqrt(a * b), [*ratios, (a - b) / (a + b)]
    return a, ratios


def elliptic_sine(u, k):
    """Jacobi's sn of modulus k: Abramowitz and Stegun 16.4."""
    limit, ratios = mean(k)
    # Whole periods left out keep the digits.
    phase = math.remainder(u * limit, 2 * math.pi) * 2 ** len(ratios)
    for ratio in reversed(ratios):
        phase = (phase + math.asin(ratio * math.sin(phase))) / 2
    return math.sin(phase)


# Three discs on a pin, as in the truth file J02: mass, place of the middle from the pin, inertia about the middle.
CLUSTER, MIDDLE, CLUSTER_INERTIA = 3.2, (0.25, -0.071875), 0.18584375


def compound_pendulum(case, time, states):
    # sin(theta/2) = k cd(w t, k), w^2 = M g d/(I + M d^2), k = sin(theta0/2): any textbook (Jacobi). cd(u) = sn(u + K).
    distance = math.hypot(*MIDDLE)
    start = math.atan2(MIDDLE[0], -MIDDLE[1])
    rate = math.sqrt(CLUSTER * GRAVITY * distance / (CLUSTER_INERTIA + CLUSTER * distance**2))
    k = math.sin(start / 2)
    quarter = math.pi / (2 * mean(k)[0])
    return abs(states[0][2] - (2 * math.asin(k * elliptic_sine(rate * time + quarter, k)) - start))


DOUBLE_TIMES = (1.0, 2.0, 3.0, 4.0, 5.0)  # s
CHAIN = {"count": 10, "length": 0.2, "mass": 0.01, "ball": 10.0}  # m, kg
CHAIN_START = 30.0  # degrees
CHAIN_TIMES = (0.2, 0.6, 1.0, 2.0, 3.0, 4.0, 5.0)  # s
TARGETS = (0.5, 0.8)  # rad
KP, KD = 20.0, 5.0  # N m/rad, N m s/rad
ARM_TIMES = (0.2, 0.4, 1.0, 2.0)  # s


def lagrange(name):
    """The greatest error of the angles of rods; of the arm that of the angles of its joints."""

    def error(case, time, states):
        truth = json.loads(TRUTHS.read_text())[name]
        exact = truth["angles"][truth["samples"].index(time)]
        off = [state[2] - angle for state, angle in zip(states, exact)]
        if name == "two_link_arm":
            off[1] -= off[0]
        return max(abs(angle) for angle in off)

    return error


def double_pendulum():
    bodies, joints, _ = hung((1.0, 1.0), (1.0, 1.0), (math.pi / 2, math.pi / 2))
    return scene(bodies, gravity=(0.0, -GRAVITY), joints=joints)


def chain_and_ball():
    count, length = CHAIN["count"], CHAIN["length"]
    bodies, joints, end = hung((length,) * count, (CHAIN["mass"],) * count, (math.radians(CHAIN_START),) * count)
    # The last joint is in the middle of the ball, so that nothing turns it.
    bodies.append(disc(end, mass=CHAIN["ball"]))
    joints.append(joint(count - 1, (0.0, -length / 2), count, (0.0, 0.0)))
    return scene(bodies, gravity=(0.0, -GRAVITY), joints=joints)


def two_link_arm():
    servos = [{"target": target, "kp": KP, "kd": KD} for target in TARGETS]
    bodies, joints, _ = hung((0.5, 0.4), (1.0, 0.8), (0.0, 0.0), servos)
    return scene(bodies, gravity=(0.0, -GRAVITY), joints=joints)


LINKS, SPAN = 50, 1.4  # m; links of 0.04 m and 0.02 kg


def catenary():
    """Links in balance: tan phi = V/H, where V goes down by the weight of a link from each to the next; H by bisection."""
    length, mass = 2.0 / LINKS, 1.0 / LINKS
    pulls = [(i - (LINKS - 1) / 2) * mass * GRAVITY for i in range(LINKS)]
    low, high = 0.0, 100.0
    while (low + high) / 2 not in (low, high):
        middle = (low + high) / 2
        width = math.fsum(length * middle / math.hypot(middle, pull) for pull in pulls)
        low, high = (middle, high) if width < SPAN else (low, middle)
    # From the downward vertical: -pi/2 would point to the left, pi/2 to the right.
    angles = [math.pi / 2 + math.atan2(pull, low) for pull in pulls]
    bodies, joints, _ = hung((length,) * LINKS, (mass,) * LINKS, angles)
    joints.append(joint(None, (SPAN, 0.0), LINKS - 1, (0.0, -length / 2)))
    return scene(bodies, gravity=(0.0, -GRAVITY), joints=joints)


def displacement(case, time, states):
    return max(math.dist(state[:2], body["at"]) for state, body in zip(states, case["bodies"], strict=True))


SEQUENCE = [0.0, 0.0, 0.0, 0.0, 1.0]
SMOOTH, IMPACTS, SLIDING, JOINTS = "smooth", "impacts", "sliding", "joints"

ALL = [
    Problem("free_flight", "m", "parabola and spin", "textbook", (0.5, 1.0, 2.0, 3.0),
            [scene([disc((1.0, 2.0), (12.0, 15.0), 3.0)], gravity=(0.0, -GRAVITY))], free_flight, SMOOTH),
    Problem("constant_acceleration", "m", "a t^2/2", "Galilei 1638", (1.0, 2.0, 5.0, 10.0),
            [scene([disc((0.0, 0.0), mass=3.0)], gravity=(10.0, 0.0))], constant_acceleration, SMOOTH),
    Problem("linear_drag", "of the way", "exponential approach to the terminal velocity", "textbook", (0.5, 1.0, 2.0, 5.0, 10.0),
            [scene([disc((0.0, 0.0), (10.0, 20.0), mass=2.0)], gravity=(0.0, -GRAVITY), drag=DRAG)], linear_drag, SMOOTH),
    Problem("spring_mass", "of the amplitude", "sine", "Hooke 1678", (0.5, 1.0, 2.0, 5.0, 10.0),
            [scene([disc((0.1, 0.0), (0.5, 0.0))], spring=100.0)], spring_mass, SMOOTH),
    Problem("elastic_bounce", "of the height", "a ball comes back for ever", "Newton's law of impact, e = 1",
            tuple(0.25 * i for i in range(1, 13)), bounces(1.0, (0.5, 0.631, 0.777)), bounce_error, IMPACTS),
    Problem("inelastic_impact", "of a second's way", "e = 0.6", "Newton's law of impact", (0.1, 0.25, 0.5, 1.0),
            [scene([disc((0.0, 0.1 + gap), (0.0, -2.0))], restitution=0.6, floor=True, gap=gap)
             for gap in (0.05, 0.0613, 0.0777)], inelastic_impact, IMPACTS),
    Problem("oblique_collision", "of the speed", "friction 0.3, e = 0.7, on a wall and of two discs", "Walton 1993",
            (1.0,), oblique_collisions(), oblique_error, IMPACTS),
    Problem("settling_bounce", "of the height", "e = 0.5, ever lower and then at rest", "Newton's law of impact",
            tuple(0.25 * i for i in range(1, 9)), bounces(0.5, (0.8, 0.937, 1.111)), bounce_error, IMPACTS),
    Problem("cradle_apart", "of the speed", "five discs with gaps: the last takes all", "exchange of velocities, impact by impact",
            (1.0,), cradle(0.01, SEQUENCE, (0.05, 0.0613, 0.0777)), cradle_error, IMPACTS),
    Problem("cradle_touching", "of the speed", "five touching discs: stiff elastic contacts pass a dispersed pulse",
            "Herrmann and Seitz 1982", (1.0,), cradle(0.0, chain(5), (0.05, 0.0613, 0.0777)), cradle_error, IMPACTS),
    Problem("cradle_touching_ideal", "of the speed", "the same, if the impacts are taken as one after the other",
            "exchange of velocities, impact by impact", (1.0,), cradle(0.0, SEQUENCE, (0.05, 0.0613, 0.0777)), cradle_error, IMPACTS),
    Problem("sliding_stop", "m", "stops after v^2/(2 mu g) and stays", "Coulomb 1785", (0.25, 0.5, 0.75, 1.0, 2.0),
            [on_floor(speed, False) for speed in (3.0, 2.3, 1.71)], sliding_stop, SLIDING),
    Problem("slide_to_roll", "m", "a sliding disc begins to roll", "textbook", (0.1, 0.25, 0.5, 1.0),
            [on_floor(speed, True) for speed in (3.0, 2.3, 1.71)], slide_to_roll, SLIDING),
    Problem("incline", "m", "stays below the angle of friction, slides above it, turns when thrown uphill", "Coulomb 1785",
            (0.5, 1.0, 2.0), [on_floor(speed, False, degrees) for degrees, speed in
                              ((15.0, 0.0), (21.7, 0.0), (21.9, 0.0), (35.0, 0.0), (30.0, -4.0))], incline, SLIDING),
    Problem("compound_pendulum", "rad", "a body on a pin swings for 20 s as an elliptic function", "Jacobi's elliptic functions",
            (1.0, 3.0, 6.0, 10.0, 15.0, 20.0),
            [scene([disc(MIDDLE, mass=CLUSTER, inertia=CLUSTER_INERTIA)], gravity=(0.0, -GRAVITY),
                   joints=[joint(None, (0.0, 0.0), 0, (-MIDDLE[0], -MIDDLE[1]))])], compound_pendulum, JOINTS),
    Problem("double_pendulum", "rad", "two rods, let go level", "Lagrange's equations", DOUBLE_TIMES, [double_pendulum()],
            lagrange("double_pendulum"), JOINTS),
    Problem("chain_and_ball", "rad", "ten links swing with a ball of a thousand times the mass of a link", "Lagrange's equations",
            CHAIN_TIMES, [chain_and_ball()], lagrange("chain_and_ball"), JOINTS),
    Problem("catenary", "m", "fifty links between two pins stay where forces are in balance", "statics", (1.0, 2.0), [catenary()],
            displacement, JOINTS),
    Problem("two_link_arm", "rad", "a controller on each joint moves an arm", "Lagrange's equations", ARM_TIMES, [two_link_arm()],
            lagrange("two_link_arm"), JOINTS),
]


def error_of(problem, states_of_cases):
    """The greatest error over cases and moments; infinite where a number is none."""
    greatest = 0.0
    for case, states_at in zip(problem.cases, states_of_cases, strict=True):
        for time, states in zip(problem.samples, states_at, strict=True):
            error = problem.error(case, time, states)
            greatest = max(greatest, error) if math.isfinite(error) else math.inf
    return greatest
