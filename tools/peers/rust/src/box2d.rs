//! Box2D v3, in single precision: the C library through the bindings of `boxdd-sys`.

use boxdd_sys::ffi::*;

use crate::job::{Job, Servo, State};

pub struct World {
    world: b2WorldId,
    discs: Vec<b2BodyId>,
    step: f32,
    substeps: i32,
    /// Stiffness of the spring in N/m, where it is a force of ours.
    pull: Option<f32>,
    /// Servos that are torques of ours, with both bodies.
    servos: Vec<(Option<b2BodyId>, b2BodyId, Servo)>,
    /// Angles are told within a turn: here they go on.
    turned: Vec<(f64, f64)>,
}

pub fn version() -> String {
    // SAFETY: takes and keeps nothing.
    let version = unsafe { b2GetVersion() };
    format!("{}.{}.{}", version.major, version.minor, version.revision)
}

fn vector(v: [f64; 2]) -> b2Vec2 {
    b2Vec2 { x: v[0] as f32, y: v[1] as f32 }
}

pub fn world(job: &Job) -> World {
    let (scene, settings) = (&job.scene, &job.settings);
    // SAFETY: definitions come from the library and live until the call returns; ids are used before the world is destroyed.
    unsafe {
        let mut def = b2DefaultWorldDef();
        def.gravity = vector(scene.gravity);
        def.enableSleep = settings.sleep;
        def.enableContinuous = settings.continuous;
        if let Some(threshold) = settings.restitution_threshold {
            def.restitutionThreshold = threshold as f32;
        }
        if let Some(hertz) = settings.contact_hertz {
            def.contactHertz = hertz as f32;
        }
        if let Some(ratio) = settings.contact_damping {
            def.contactDampingRatio = ratio as f32;
        }
        if let Some(speed) = settings.push_speed {
            def.contactSpeed = speed as f32;
        }
        let world = b2CreateWorld(&def);
        b2World_EnableWarmStarting(world, settings.warm_start);
        b2World_EnableSpeculative(world, settings.speculative);
        if !settings.recycling {
            b2World_SetContactRecycleDistance(world, 0.0);
        }
        let mut shape = b2DefaultShapeDef();
        shape.material.friction = scene.material.friction as f32;
        shape.material.restitution = scene.material.restitution as f32;
        let ground = b2CreateBody(world, &b2DefaultBodyDef());
        if scene.floor || scene.width.is_some() {
            // The upper side of a box, as boxes are what floors are made of; wide enough for all that happens.
            let floor = b2MakeOffsetBox(100.0, 1.0, b2Vec2 { x: 0.0, y: -1.0 }, b2Rot { c: 1.0, s: 0.0 });
            b2CreatePolygonShape(ground, &shape, &floor);
        }
        for x in scene.width.iter().flat_map(|width| [-1.0, *width as f32 + 1.0]) {
            let wall = b2MakeOffsetBox(1.0, 100.0, b2Vec2 { x, y: 100.0 }, b2Rot { c: 1.0, s: 0.0 });
            b2CreatePolygonShape(ground, &shape, &wall);
        }
        let mut discs = Vec::new();
        for disc in &scene.bodies {
            let mut body = b2DefaultBodyDef();
            body.type_ = b2BodyType_b2_dynamicBody;
            body.position = vector(disc.at);
            body.rotation = b2Rot { c: disc.angle.cos() as f32, s: disc.angle.sin() as f32 };
            body.linearVelocity = vector(disc.velocity);
            body.angularVelocity = disc.spin as f32;
            body.linearDamping = scene.drag as f32;
            body.motionLocks.angularZ = !disc.turns;
            let id = b2CreateBody(world, &body);
            if scene.joints.is_empty() {
                let circle = b2Circle { center: vector([0.0, 0.0]), radius: disc.radius as f32 };
                b2CreateCircleShape(id, &shape, &circle);
            }
            let inertia = if disc.turns { disc.inertia() } else { 0.0 };
            let mass =
                b2MassData { mass: disc.mass as f32, center: vector([0.0, 0.0]), rotationalInertia: inertia as f32 };
            b2Body_SetMassData(id, mass);
            discs.push(id);
        }
        let mut pull = None;
        if let Some(stiffness) = scene.spring {
            if settings.spring_joint {
                let mut joint = b2DefaultDistanceJointDef();
                joint.base.bodyIdA = ground;
                joint.base.bodyIdB = discs[0];
                joint.base.localFrameA.p = vector([-1.0, 0.0]);
                joint.length = 1.0;
                joint.enableSpring = true;
                joint.hertz = ((stiffness / scene.bodies[0].mass).sqrt() / std::f64::consts::TAU) as f32;
                joint.dampingRatio = 0.0;
                b2CreateDistanceJoint(world, &joint);
            } else {
                pull = Some(stiffness as f32);
            }
        }
        let mut servos = Vec::new();
        for joint in &scene.joints {
            let (a, b) = (joint.a.map(|index| discs[index]), discs[joint.b]);
            let mut hinge = b2DefaultRevoluteJointDef();
            hinge.base.bodyIdA = a.unwrap_or(ground);
            hinge.base.bodyIdB = b;
            hinge.base.localFrameA.p = vector(joint.anchor_a);
            hinge.base.localFrameB.p = vector(joint.anchor_b);
            if let Some(hertz) = settings.joint_hertz {
                hinge.base.constraintHertz = hertz as f32;
            }
            if let Some(ratio) = settings.joint_damping {
                hinge.base.constraintDampingRatio = ratio as f32;
            }
            if let Some(servo) = joint.servo {
                if settings.servo_joint {
                    // Its stiffness is told as a frequency of the inertia that the joint has without its hinge.
                    let inverse = |index: usize| 1.0 / scene.bodies[index].inertia();
                    let inertia = 1.0 / (inverse(joint.b) + joint.a.map_or(0.0, inverse));
                    let rate = (servo.kp / inertia).sqrt();
                    hinge.enableSpring = true;
                    hinge.targetAngle = servo.target as f32;
                    hinge.hertz = (rate / std::f64::consts::TAU) as f32;
                    hinge.dampingRatio = (servo.kd / (2.0 * inertia * rate)) as f32;
                } else {
                    servos.push((a, b, servo));
                }
            }
            b2CreateRevoluteJoint(world, &hinge);
        }
        let turned = scene.bodies.iter().map(|disc| (disc.angle, disc.angle)).collect();
        World { world, discs, step: job.step as f32, substeps: settings.substeps as i32, pull, servos, turned }
    }
}

impl crate::job::World for World {
    fn step(&mut self) {
        // SAFETY: the ids are of this world, which lives.
        unsafe {
            if let Some(stiffness) = self.pull {
                let x = b2Body_GetPosition(self.discs[0]).x;
                b2Body_ApplyForceToCenter(self.discs[0], b2Vec2 { x: -stiffness * x, y: 0.0 }, true);
            }
            for &(a, b, servo) in &self.servos {
                let motion = |body| {
                    let rotation = b2Body_GetRotation(body);
                    (rotation.s.atan2(rotation.c), b2Body_GetAngularVelocity(body))
                };
                let (angle, rate) = motion(b);
                let (angle_a, rate_a) = a.map_or((0.0, 0.0), motion);
                let torque =
                    servo.kp as f32 * (servo.target as f32 - (angle - angle_a)) - servo.kd as f32 * (rate - rate_a);
                b2Body_ApplyTorque(b, torque, true);
                if let Some(a) = a {
                    b2Body_ApplyTorque(a, -torque, true);
                }
            }
            b2World_Step(self.world, self.step, self.substeps);
        }
    }

    fn follow(&mut self) {
        for (disc, (angle, last)) in self.discs.iter().zip(&mut self.turned) {
            // SAFETY: the ids are of this world, which lives.
            let rotation = unsafe { b2Body_GetRotation(*disc) };
            let now = f64::from(rotation.s).atan2(f64::from(rotation.c));
            *angle += (now - *last + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
            *last = now;
        }
    }

    fn states(&self) -> Vec<State> {
        let state = |(&disc, (angle, _)): (&b2BodyId, &(f64, f64))| {
            // SAFETY: the ids are of this world, which lives.
            let (at, velocity, spin) =
                unsafe { (b2Body_GetPosition(disc), b2Body_GetLinearVelocity(disc), b2Body_GetAngularVelocity(disc)) };
            let numbers = [at.x, at.y, 0.0, velocity.x, velocity.y, spin];
            let mut numbers = numbers.map(f64::from);
            numbers[2] = *angle;
            numbers
        };
        self.discs.iter().zip(&self.turned).map(state).collect()
    }
}

impl Drop for World {
    fn drop(&mut self) {
        // SAFETY: created by us and destroyed once.
        unsafe { b2DestroyWorld(self.world) };
    }
}
