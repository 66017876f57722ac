"""Runs scenes of `problems.py` in pymunk and MuJoCo, as the Rust program does in Rapier and Box2D.

`run(job)` takes what a job of the Rust program holds and gives what it answers.
"""

import importlib
import itertools
import math
import time

NEEDED = "pip install pymunk mujoco numpy"


def versions() -> dict[str, str]:
    found = {}
    for name in ("pymunk", "mujoco"):
        try:
            module = importlib.import_module(name)
            found[name] = getattr(module, "__version__", None) or module.version
        except ImportError:
            found[name] = ""  # not installed
    return found


def inertia_of(disc):
    return disc["mass"] * disc["radius"] ** 2 / 2 if disc["inertia"] is None else disc["inertia"]


class Pymunk:
    """Chipmunk through pymunk, in double precision."""

    DEFAULTS = {
        "iterations": None, "collision_slop": None, "collision_bias": None, "collision_persistence": None,
        "sleep_time": None, "spring_joint": True,
        # Servos as damped springs of the engine, or as torques of the caller.
        "servo_joint": True,
        # Share of the error of a joint that is left after a second.
        "joint_bias": None,
    }

    def __init__(self, scene, step, settings):
        import pymunk

        self.step = step
        space = self.space = pymunk.Space()
        space.gravity = scene["gravity"]
        for name in ("iterations", "collision_slop", "collision_bias", "collision_persistence"):
            if settings[name] is not None:
                setattr(space, name, settings[name])
        if settings["sleep_time"] is not None:
            space.sleep_time_threshold = settings["sleep_time"]
        # `damping` is the share of the velocity that is left after a second.
        space.damping = math.exp(-scene["drag"])
        # Friction and restitution of a contact are products of both shapes' values.
        material = {name: math.sqrt(value) for name, value in scene["material"].items()}
        shapes = []
        if scene["floor"]:
            # Its upper side is y = 0.
            shapes.append(pymunk.Poly(space.static_body, [(-100, -2), (100, -2), (100, 0), (-100, 0)]))
        self.discs = []
        for disc in scene["bodies"]:
            moment = inertia_of(disc) if disc["turns"] else math.inf
            body = pymunk.Body(disc["mass"], moment)
            body.position, body.velocity, body.angular_velocity = disc["at"], disc["velocity"], disc["spin"]
            body.angle = disc["angle"]
            self.discs.append(body)
            shapes += [body] if scene["joints"] else [body, pymunk.Circle(body, disc["radius"])]
        for shape in shapes:
            if isinstance(shape, pymunk.Shape):
                shape.friction, shape.elasticity = material["friction"], material["restitution"]
        space.add(*shapes)
        self.servos = []
        for joint in scene["joints"]:
            a = space.static_body if joint["a"] is None else self.discs[joint["a"]]
            b, servo = self.discs[joint["b"]], joint["servo"]
            pivot = pymunk.PivotJoint(a, b, joint["anchor_a"], joint["anchor_b"])
            pivot.collide_bodies = False
            if settings["joint_bias"] is not None:
                pivot.error_bias = settings["joint_bias"]
            space.add(pivot)
            if servo and settings["servo_joint"]:
                # Its angle is that of a less that of b.
                space.add(pymunk.DampedRotarySpring(a, b, -servo["target"], servo["kp"], servo["kd"]))
            elif servo:
                self.servos.append((a, b, servo["target"], servo["kp"], servo["kd"]))
        self.pull = None
        if scene["spring"] is not None:
            if settings["spring_joint"]:
                space.add(pymunk.DampedSpring(space.static_body, self.discs[0], (-1, 0), (0, 0), 1, scene["spring"], 0))
            else:
                self.pull = scene["spring"]

    def advance(self, steps):
        if self.pull is not None:
            body, step = self.discs[0], self.space.step
            for _ in range(steps):
                body.force = (-self.pull * body.position.x, 0)
                step(self.step)
            return
        if self.servos:
            for _ in range(steps):
                for a, b, target, kp, kd in self.servos:
                    torque = kp * (target - b.angle + a.angle) - kd * (b.angular_velocity - a.angular_velocity)
                    b.torque += torque
                    if a is not self.space.static_body:
                        a.torque -= torque
                self.space.step(self.step)
            return
        # The C function itself: the method of pymunk adds callbacks that nothing here needs.
        from pymunk._chipmunk_cffi import lib

        step, space, length = lib.cpSpaceStep, self.space._space, self.step
        for _ in range(steps):
            step(space, length)

    def states(self):
        return [[*b.position, b.angle, *b.velocity, b.angular_velocity] for b in self.discs]


def damping_ratio(restitution):
    """Of a spring and dashpot that never pull, so that they give this restitution: Schwager and Poeschel, Granular Matter 9, 2007."""

    def given(ratio):
        if ratio < 1:
            root = math.sqrt(1 - ratio**2)
            return math.exp(-ratio / root * math.atan2(2 * ratio * root, 2 * ratio**2 - 1))
        return 0.0

    low, high = 0.0, 1.0
    if restitution >= 1:
        return 0.0
    while high - low > 1e-15:
        middle = (low + high) / 2
        low, high = (middle, high) if given(middle) > restitution else (low, middle)
    return low


class Mujoco:
    """MuJoCo, in double precision: spheres on two slides and a hinge."""

    DEFAULTS = {
        "integrator": None, "cone": None, "impratio": None, "iterations": None, "tolerance": None, "noslip_iterations": None,
        # Steps that a contact lasts; None: `solref` and `solimp` as they are, which have no restitution.
        "contact_steps": None,
        # Steps in which friction of such contacts stops slip (`solreffriction`); None: as `solref`.
        "friction_steps": None,
        "spring_joint": True,
        # Servos as actuators of the engine, or as torques of the caller.
        "servo_joint": True,
        # Time constant, in steps, of what closes a loop; None: as it is, 0.02 s.
        "closure_steps": None,
    }

    def __init__(self, scene, step, settings):
        import mujoco

        self.library = mujoco
        option = f'timestep="{step!r}" gravity="{scene["gravity"][0]!r} {scene["gravity"][1]!r} 0"'
        for name in ("integrator", "cone", "impratio", "iterations", "tolerance", "noslip_iterations"):
            if settings[name] is not None:
                option += f' {name}="{settings[name]}"'
        material = scene["material"]
        condim = 3 if material["friction"] else 1
        geom = f'friction="{material["friction"]!r} 0 0" condim="{condim}"'
        stiff = ""
        if settings["contact_steps"] is not None:
            # Negative values are stiffness and damping over the effective mass: contacts then are springs and dashpots, and
            # the restitution follows from the ratio of damping.
            rate = math.pi / (settings["contact_steps"] * step)
            damping = 2 * damping_ratio(material["restitution"]) * rate
            stiff = f'solref="{-rate * rate!r} {-damping!r}" solimp="0.9999 0.9999 0.001 0.5 2"'
        bodies = ""
        for place, disc in enumerate(scene["bodies"]):
            mass, inertia = disc["mass"], inertia_of(disc)
            hinge = '<joint type="hinge" axis="0 0 1"/>' if disc["turns"] else ""
            spring = ""
            if scene["spring"] is not None and settings["spring_joint"]:
                spring = f'stiffness="{scene["spring"]!r}" springref="{-disc["at"][0]!r}"'
            drag = f'damping="{scene["drag"] * mass!r}"'
            bodies += f"""<body pos="{disc["at"][0]!r} {disc["at"][1]!r} 0">
                <inertial pos="0 0 0" mass="{mass!r}" diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>
                <joint type="slide" axis="1 0 0" {drag} {spring}/><joint type="slide" axis="0 1 0" {drag}/>{hinge}
                <geom name="disc{place}" type="sphere" size="{disc["radius"]!r}" {geom} {stiff}/></body>"""
        floor = f'<geom name="floor" type="plane" size="100 100 1" zaxis="0 1 0" {geom} {stiff}/>' if scene["floor"] else ""
        pairs = ""
        if settings["friction_steps"] is not None:
            names = [f"disc{place}" for place in range(len(scene["bodies"]))] + (["floor"] if floor else [])
            stiff += f' solreffriction="{settings["friction_steps"] * step!r} 1"'
            for first, second in itertools.combinations(names, 2):
                law = f'condim="{condim}" friction="{material["friction"]!r} {material["friction"]!r} 0 0 0" {stiff}'
                pairs += f'<pair geom1="{first}" geom2="{second}" {law}/>'
        text = f"<mujoco><option {option}/><worldbody>{floor}{bodies}</worldbody><contact>{pairs}</contact></mujoco>"
        self.model = mujoco.MjModel.from_xml_string(text)
        self.data = mujoco.MjData(self.model)
        self.starts = [disc["at"] for disc in scene["bodies"]]
        self.columns, column = [], 0
        for disc in scene["bodies"]:
            self.columns.append((column, disc["turns"]))
            column += 3 if disc["turns"] else 2
        for disc, (column, turns) in zip(scene["bodies"], self.columns, strict=True):
            self.data.qvel[column : column + 2] = disc["velocity"]
            if turns:
                self.data.qvel[column + 2] = disc["spin"]

    def advance(self, steps):
        if steps:
            self.library.mj_step(self.model, self.data, nstep=steps)
        if any(warning.number for warning in self.data.warning):
            kinds = [self.library.mjtWarning(i).name for i, warning in enumerate(self.data.warning) if warning.number]
            raise ArithmeticError(f"warned of {', '.join(kinds)}")

    def states(self):
        found = []
        for (x, y), (column, turns) in zip(self.starts, self.columns, strict=True):
            q, v = self.data.qpos[column : column + 3], self.data.qvel[column : column + 3]
            angle, spin = (float(q[2]), float(v[2])) if turns else (0.0, 0.0)
            found.append([x + float(q[0]), y + float(q[1]), angle, float(v[0]), float(v[1]), spin])
        return found


class MujocoJoints(Mujoco):
    """Hinges in generalised coordinates: each body stands in that which holds it. What closes a loop is a constraint."""

    def __init__(self, scene, step, settings):
        import mujoco

        self.library = mujoco
        # Warnings are counted in the data; without this they also go to a file in the working directory.
        mujoco.set_mju_user_warning(lambda text: None)
        option = f'timestep="{step!r}" gravity="{scene["gravity"][0]!r} {scene["gravity"][1]!r} 0"'
        for name in ("integrator", "iterations", "tolerance"):
            if settings[name] is not None:
                option += f' {name}="{settings[name]}"'
        self.discs = scene["bodies"]
        self.servos, self.above = [], {}
        texts, actuators, closures = {}, "", ""
        soft = ""
        if settings["closure_steps"] is not None:
            soft = f'solref="{settings["closure_steps"] * step!r} 1" solimp="0.9999 0.9999 0.001 0.5 2"'
        for joint in scene["joints"]:
            b = joint["b"]
            # All frames begin unturned: anchors turn by the angle of the body.
            x, y = turned(joint["anchor_b"], self.discs[b]["angle"])
            if b in self.above:
                closures += f'<connect body1="disc{b}" anchor="{x!r} {y!r} 0" {soft}/>'
                continue
            disc, a = self.discs[b], joint["a"]
            upper = (0.0, 0.0) if a is None else self.discs[a]["at"]
            inertia = inertia_of(disc)
            texts[b] = f"""<body name="disc{b}" pos="{disc["at"][0] - upper[0]!r} {disc["at"][1] - upper[1]!r} 0">
                <inertial pos="0 0 0" mass="{disc["mass"]!r}" diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>
                <joint name="joint{b}" type="hinge" axis="0 0 1" pos="{x!r} {y!r} 0"/>"""
            self.above[b] = a
            if joint["servo"]:
                servo = joint["servo"]
                start = disc["angle"] - (0.0 if a is None else self.discs[a]["angle"])
                self.servos.append((b, servo["target"] - start, servo["kp"], servo["kd"]))
                actuators += f'<position joint="joint{b}" kp="{servo["kp"]!r}" kv="{servo["kd"]!r}"/>'
        bodies = "".join(texts[b] for b in self.above) + "</body>" * len(self.above)  # one chain
        if not settings["servo_joint"]:
            actuators = ""
        self.model = mujoco.MjModel.from_xml_string(
            f"<mujoco><option {option}/><worldbody>{bodies}</worldbody><equality>{closures}</equality>"
            f"<actuator>{actuators}</actuator></mujoco>"
        )
        self.data = mujoco.MjData(self.model)
        if actuators:
            self.data.ctrl[:] = [target for _, target, _, _ in self.servos]
            self.servos = []

    def advance(self, steps):
        if self.servos:
            q, v, torque = self.data.qpos, self.data.qvel, self.data.qfrc_applied
            for _ in range(steps):
                for joint, target, kp, kd in self.servos:
                    torque[joint] = kp * (target - q[joint]) - kd * v[joint]
                self.library.mj_step(self.model, self.data)
            steps = 0
        super().advance(steps)

    def states(self):
        # A step ends with new coordinates, but places of before.
        self.library.mj_kinematics(self.model, self.data)
        self.library.mj_comPos(self.model, self.data)
        self.library.mj_comVel(self.model, self.data)
        found, angles = [], {}
        for b, a in self.above.items():
            angles[b] = angles.get(a, 0.0) + float(self.data.qpos[b])
            velocity = self._velocity(b + 1)
            x, y = (float(number) for number in self.data.xpos[b + 1][:2])
            found.append([x, y, self.discs[b]["angle"] + angles[b], velocity[3], velocity[4], velocity[2]])
        return found

    def _velocity(self, body):
        import numpy

        six = numpy.zeros(6)
        self.library.mj_objectVelocity(self.model, self.data, self.library.mjtObj.mjOBJ_BODY, body, six, 0)
        return [float(number) for number in six]


def turned(vector, angle):
    x, y = vector
    return x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)


ENGINES = {"pymunk": Pymunk, "mujoco": Mujoco}


def run(job: dict) -> dict:
    engine = ENGINES[job["engine"]]
    unknown = set(job["settings"]) - set(engine.DEFAULTS)
    if unknown:
        raise SystemExit(f"{job['engine']} has no setting {', '.join(sorted(unknown))}; there are {', '.join(engine.DEFAULTS)}")
    settings = engine.DEFAULTS | job["settings"]
    if engine is Mujoco and job["scene"]["joints"]:
        engine = MujocoJoints
    best = math.inf
    for _ in range(job["repeats"]):
        try:
            world = engine(job["scene"], job["step"], settings)
            states, done, seconds = [], 0, 0.0
            for sample in job["samples"]:
                start = time.thread_time()
                world.advance(sample - done)
                seconds += time.thread_time() - start
                done = sample
                states.append(world.states())
        except (ArithmeticError, ValueError) as error:
            return {"states": [], "seconds": 0.0, "failed": str(error)}
        best = min(best, seconds)
    if not all(math.isfinite(number) for at in states for state in at for number in state):
        return {"states": [], "seconds": 0.0, "failed": "numbers stopped being finite"}
    return {"states": states, "seconds": best, "failed": None}
