//! A model from outside that tells more or fewer indicators inside a step than at its beginning. Candidate pairs that are renewed within a
//! step do so, too.
//!
//! Law: a body at `x = v t` passes the place `a` at `a/v`. Tolerance: rounding of the time and the place.

use bevy_app::App;
use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::{Bend, Energies, Events, Indicator, Model, State, SteadySpring, TickAppExt};

/// In m/s and m.
const SPEED: f64 = 3.0;
const LINE: f64 = 1.5;

/// Notes when body 0 passes a line. Beside that it tells of something that lasts, between two places.
struct Line {
    also_between: (f64, f64),
    passed: Vec<f64>,
}

impl Model for Line {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn has_modes(&self) -> bool {
        true
    }

    fn events(&mut self) -> Option<&mut dyn Events> {
        Some(self)
    }
}

impl Events for Line {
    fn tell(&mut self, state: &State, told: &mut Vec<Indicator>) {
        let place = state.bodies().position[0].x;
        // The slope is unknown, so stages and looks tell what happens inside a step.
        let left = if self.passed.is_empty() { LINE - place } else { 1.0 };
        told.push(Indicator::of_value(left, Bend::Fitted));
        if (self.also_between.0..self.also_between.1).contains(&place) {
            told.push(Indicator::of_value(1.0, Bend::Fitted));
        }
    }

    fn switch(&mut self, state: &mut State, fired: &[usize]) {
        if fired.contains(&0) {
            self.passed.push(state.evaluation().time);
        }
    }
}

#[test]
fn events_are_found_beside_indicators_that_come_and_go_within_a_step() {
    for clock in ["tolerance: 1e-6", "method: Dop853, tick: 1", "method: RungeKutta4, tick: 1", "method: Reference"] {
        for also_between in [(-1.0, 0.9), (-1.0, 2.5), (0.4, 9.0), (0.9, 2.1), (2.1, 2.2)] {
            let scene = format!(
                "Scene(format: 1, clock: (duration: 1, {clock}), contacts: None,
                    bodies: [(name: \"cart\", at: (0, 0), velocity: ({SPEED:?}, 0), atoms: Disc(radius: 0.1, mass: 2))])"
            );
            let line = move |app: &mut App| {
                app.add_model(Line { also_between, passed: Vec::new() });
            };
            let source = Source::new("line.ron", scene);
            let mut simulation = Simulation::load_with(&source, &Overrides::default(), line).expect("a correct scene");
            simulation.run_to_end().expect("numbers stay finite");
            let passed = &simulation.state().model::<Line>().expect("the model is there").passed;
            let [time] = passed[..] else { panic!("{clock} {also_between:?}: passed at {passed:?}") };
            assert!((time - LINE / SPEED).abs() < 1e-12, "{clock} {also_between:?}: at {time} s");
        }
    }
}
