#![allow(missing_docs)]
use jostle::{world::*, tick::{self,*}, forces, contacts, integrate};
use bevy_app::App; use glam::DVec2;
fn main(){
  let mut app=App::empty(); app.add_tick();
  let mut m=Materials::default(); m.table.push(material::PairCoefficients{friction_static:0.3,friction_dynamic:0.3,inelasticity:0.3}); app.insert_resource(m);
  forces::gravity::install(forces::gravity::Gravity(DVec2::new(0.0,-3.0)),&mut app);
  contacts::penalty::install(Default::default(),&mut app);
  integrate::plugin(&mut app);
  let w=app.world_mut();
  let atom=|x:f64,y:f64,r:f64,m:f64|Atom{offset:DVec2::new(x,y),radius:r,mass:m,stiffness:1000.0,material:MaterialIndex(0)};
  let mut k=0; let mut wall=|w:&mut bevy_ecs::world::World,l:(f64,f64),r:(f64,f64)|{w.spawn(Wall{key:k,left:l.into(),right:r.into(),material:MaterialIndex(0)});k+=1;};
  wall(w,(6.,1.),(6.,0.)); wall(w,(0.,0.),(0.,1.)); wall(w,(1.,0.),(0.,0.)); wall(w,(0.,6.),(1.,6.));
  NewBody{motion:Motion::Fixed,position:DVec2::new(3.,3.),atoms:[(0.6,4.38),(1.2,3.6),(2.1,2.7),(3.0,1.8),(3.9,0.9),(4.8,2.4),(5.4,3.96)].map(|(x,y)|atom(x-3.,y-3.,0.3,1.0)).to_vec(),..Default::default()}.spawn(w);
  for (i,(x,y,vx,vy,s)) in [(3.,4.,-0.1,0.05,-0.5),(2.,5.,-0.6,0.03,1.2),(4.,5.,0.2,0.4,0.5),(3.5,5.5,0.1,0.3,4.0),(1.5,5.5,-0.3,0.2,-4.0)].into_iter().enumerate(){
    let mut atoms=vec![]; for a in 0..8{for b in 0..2{ atoms.push(atom((a as f64-3.5)*0.1*(1.0-0.1*i as f64),(b as f64-0.5)*0.1,0.05,0.01));}}
    let inertia=atoms.iter().map(|a|a.mass*a.offset.length_squared()).sum();
    NewBody{name:format!("b{i}"),position:DVec2::new(x,y),velocity:DVec2::new(vx,vy),spin:s,mass:0.16,inertia,atoms,..Default::default()}.spawn(w);
  }
  for _ in 0..5 {
  let t=std::time::Instant::now(); let n=20000; tick::step(w,n).unwrap(); let e=t.elapsed();
  let tot=balance::Totals::of(w); let l=*w.resource::<Ledger>(); let st=l.start.unwrap();
  println!("{:.0} ns/tick hash {:x} E {:?}\n  start {:?} friction {:.4} inel {:.4} residual {:.2e} P res {:?} L res {:.2e} deepest {:?}", e.as_nanos() as f64/n as f64, hash::state_hash(w.resource::<Bodies>()), tot, st.energy(), l.friction.value(), l.inelasticity.value(), tot.energy()+l.friction.value()+l.inelasticity.value()-st.energy(), (tot.momentum.x-st.momentum.x-l.impulse[0].value(),tot.momentum.y-st.momentum.y-l.impulse[1].value()), tot.angular_momentum-st.angular_momentum-l.angular_impulse.value(), w.resource::<contacts::DeepestOverlap>());
  println!("  cand {} {}", w.resource::<contacts::CandidatePairs>().atoms.len(), w.resource::<contacts::CandidatePairs>().version);
  }
}
