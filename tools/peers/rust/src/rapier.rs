//! Rapier, in single and in double precision: the same source for both crates.

macro_rules! rapier {
    ($module:ident, $crate_name:ident, $real:ty) => {
        pub mod $module {
            use $crate_name::na::Unit;
            use $crate_name::prelude::*;

            use crate::job::{Job, Servo, State};

            pub struct World {
                world: PhysicsWorld,
                discs: Vec<RigidBodyHandle>,
                /// Stiffness of the spring in N/m, where it is a force of ours.
                pull: Option<$real>,
                /// Servos that are torques of ours, with the places of both bodies.
                servos: Vec<(Option<RigidBodyHandle>, RigidBodyHandle, Servo)>,
                /// Angles are told within a turn: here they go on.
                turned: Vec<(f64, f64)>,
            }

            pub fn world(job: &Job) -> World {
                let (scene, settings) = (&job.scene, &job.settings);
                let mut world = PhysicsWorld::new();
                let vector = |v: [f64; 2]| Vector::new(v[0] as $real, v[1] as $real);
                world.gravity = vector(scene.gravity);
                let parameters = &mut world.integration_parameters;
                parameters.dt = job.step as $real;
                parameters.num_solver_iterations = settings.substeps as usize;
                for softness in [&mut parameters.contact_softness, &mut parameters.static_contact_softness] {
                    if let Some(hertz) = settings.contact_hertz {
                        softness.natural_frequency = hertz as $real;
                    }
                    if let Some(ratio) = settings.contact_damping {
                        softness.damping_ratio = ratio as $real;
                    }
                }
                if let Some(speed) = settings.push_speed {
                    parameters.normalized_max_corrective_velocity = speed as $real;
                }
                if let Some(distance) = settings.prediction {
                    parameters.normalized_prediction_distance = distance as $real;
                }
                if let Some(iterations) = settings.iterations {
                    parameters.num_internal_pgs_iterations = iterations as usize;
                }
                parameters.contact_recycling = settings.recycling;
                if !settings.continuous {
                    parameters.max_ccd_substeps = 0;
                }
                if !settings.warm_start {
                    parameters.warmstart_coefficient = 0.0;
                }
                let material = |collider: ColliderBuilder| {
                    collider.friction(scene.material.friction as $real).restitution(scene.material.restitution as $real)
                };
                let mut half_plane = |normal: Vector, x: $real| {
                    let half_plane = ColliderBuilder::halfspace(Unit::new_unchecked(normal.into()));
                    world.colliders.insert(material(half_plane.translation(Vector::new(x, 0.0))));
                };
                if scene.floor || scene.width.is_some() {
                    half_plane(Vector::new(0.0, 1.0), 0.0);
                }
                if let Some(width) = scene.width {
                    half_plane(Vector::new(1.0, 0.0), 0.0);
                    half_plane(Vector::new(-1.0, 0.0), width as $real);
                }
                let mut discs = Vec::new();
                for disc in &scene.bodies {
                    let mass = MassProperties::new(Vector::new(0.0, 0.0), disc.mass as $real, disc.inertia() as $real);
                    let mut body = RigidBodyBuilder::dynamic()
                        .translation(vector(disc.at))
                        .rotation(disc.angle as $real)
                        .linvel(vector(disc.velocity))
                        .angvel(disc.spin as $real)
                        .linear_damping(scene.drag as $real)
                        .can_sleep(settings.sleep)
                        .additional_mass_properties(mass);
                    if !disc.turns {
                        body = body.lock_rotations();
                    }
                    let handle = world.bodies.insert(body);
                    if scene.joints.is_empty() {
                        let collider = material(ColliderBuilder::ball(disc.radius as $real).density(0.0));
                        world.colliders.insert_with_parent(collider, handle, &mut world.bodies);
                    }
                    discs.push(handle);
                }
                let mut pull = None;
                if let Some(stiffness) = scene.spring {
                    if settings.spring_joint {
                        let anchor = world.bodies.insert(RigidBodyBuilder::fixed().translation(Vector::new(-1.0, 0.0)));
                        let spring = SpringJointBuilder::new(1.0, stiffness as $real, 0.0);
                        world.impulse_joints.insert(anchor, discs[0], spring, true);
                    } else {
                        pull = Some(stiffness as $real);
                    }
                }
                let ground = (!scene.joints.is_empty()).then(|| world.bodies.insert(RigidBodyBuilder::fixed()));
                let mut servos = Vec::new();
                let mut held = vec![false; discs.len()];
                let mut reduced = None;
                let mut coordinates = Vec::new();
                for joint in &scene.joints {
                    let (a, b) = (joint.a.map(|index| discs[index]), discs[joint.b]);
                    let mut hinge = RevoluteJointBuilder::new()
                        .local_anchor1(vector(joint.anchor_a))
                        .local_anchor2(vector(joint.anchor_b))
                        .contacts_enabled(false);
                    if let Some(servo) = joint.servo {
                        if settings.servo_joint {
                            hinge = hinge.motor_model(MotorModel::ForceBased).motor_position(
                                servo.target as $real,
                                servo.kp as $real,
                                servo.kd as $real,
                            );
                        } else {
                            servos.push((a, b, servo));
                        }
                    }
                    let upper = a.or(ground).expect("there is a ground where there are joints");
                    let closes = std::mem::replace(&mut held[joint.b], true);
                    if settings.multibody && !closes {
                        reduced = world.multibody_joints.insert(upper, b, hinge, true);
                        let angle_a = joint.a.map_or(0.0, |a| scene.bodies[a].angle);
                        coordinates.push((scene.bodies[joint.b].angle - angle_a) as $real);
                    } else {
                        world.impulse_joints.insert(upper, b, hinge, true);
                    }
                }
                if let Some((multibody, _)) = reduced.and_then(|handle| world.multibody_joints.get_mut(handle)) {
                    // Its coordinates begin at 0, whatever the poses of bodies are; those of the ground come first.
                    let mut moves = vec![0.0; multibody.ndofs() - coordinates.len()];
                    moves.extend(coordinates);
                    multibody.apply_displacements(&moves);
                    multibody.forward_kinematics(&world.bodies, true);
                    multibody.update_rigid_bodies(&mut world.bodies, true);
                    if let Some(damping) = settings.joint_damping {
                        multibody.damping_mut().fill(damping as $real);
                    }
                }
                let turned = scene.bodies.iter().map(|disc| (disc.angle, disc.angle)).collect();
                World { world, discs, pull, servos, turned }
            }

            impl crate::job::World for World {
                fn step(&mut self) {
                    if let Some(stiffness) = self.pull {
                        let body = &mut self.world.bodies[self.discs[0]];
                        let force = Vector::new(-stiffness * body.translation().x, 0.0);
                        body.reset_forces(true);
                        body.add_force(force, true);
                    }
                    for &(a, b, servo) in &self.servos {
                        let bodies = &mut self.world.bodies;
                        let motion = |body: &RigidBody| (body.rotation().angle(), body.angvel());
                        let (angle, rate) = motion(&bodies[b]);
                        let (angle_a, rate_a) = a.map_or((0.0, 0.0), |a| motion(&bodies[a]));
                        let torque = servo.kp as $real * (servo.target as $real - (angle - angle_a))
                            - servo.kd as $real * (rate - rate_a);
                        // Torques stay until they are reset; a body comes as `b` before it comes as `a`.
                        bodies[b].reset_torques(true);
                        bodies[b].add_torque(torque, true);
                        if let Some(a) = a {
                            bodies[a].add_torque(-torque, true);
                        }
                    }
                    self.world.step();
                }

                fn follow(&mut self) {
                    for (disc, (angle, last)) in self.discs.iter().zip(&mut self.turned) {
                        let now = f64::from(self.world.bodies[*disc].rotation().angle());
                        *angle += (now - *last + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU)
                            - std::f64::consts::PI;
                        *last = now;
                    }
                }

                fn states(&self) -> Vec<State> {
                    let state = |(disc, (angle, _)): (&RigidBodyHandle, &(f64, f64))| {
                        let body = &self.world.bodies[*disc];
                        let (at, velocity) = (body.translation(), body.linvel());
                        let numbers = [at.x, at.y, 0.0, velocity.x, velocity.y, body.angvel()];
                        let mut numbers = numbers.map(f64::from);
                        numbers[2] = *angle;
                        numbers
                    };
                    self.discs.iter().zip(&self.turned).map(state).collect()
                }
            }
        }
    };
}

rapier!(single, rapier2d, f32);
rapier!(double, rapier2d_f64, f64);
