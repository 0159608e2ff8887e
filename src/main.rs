use vglare::gpu::*; use vglare::plan::*; use vglare::renderer::*; use vglare::scene::*; use vglare::series::Bell; use vglare::frame::*; use glam::DVec2;
fn main() {
  let k: usize = std::env::args().nth(1).unwrap().parse().unwrap();
  let s: f64 = std::env::args().nth(2).unwrap().parse().unwrap();
  let mut x = 12345u64; let mut r = || { x = x.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (x>>11) as f64/(1u64<<53) as f64 };
  let ghosts: Vec<Ghost> = (0..k).map(|_| Ghost{bell:Bell::Gaussian, center: DVec2::new(r()*4.0-2.0, r()*2.4-1.2), size: DVec2::splat(s*(1.0+r())), radiance:[r(),r(),r()]}).collect();
  let d = Device::open(&[Backend::Egl]).unwrap();
  let frame = Frame::full(1920,1080);
  let mut ren = Renderer::new(&d).unwrap();
  for e in [Evaluator::Grid, Evaluator::Grid, Evaluator::Rows] {
   for tol in [1e-2] {
    let t=std::time::Instant::now();
    let req=Request{evaluator:Some(e), degree: Some([10,10]), period: Some(DVec2::new(8.0,6.0)), ..Request::new(frame, tol)};
    let p = match plan(&ghosts,&req){Ok(p)=>p,Err(e)=>{println!("{e}");continue}};
    let tp=t.elapsed();
    if p.costs[0].milliseconds>20000.0 {println!("{e} too slow {:?}", p.costs); continue}
    ren.set_timing(false); 
    println!("{e} {tol} plan {tp:?} T {} deg {:?} terms {} groups {} lattice {:?} dropped {} pred {:?} total {:.2e} cost {:?}", p.period, p.degree,p.terms,p.groups.len(),p.lattice,p.dropped,p.predicted,p.predicted.total(),p.costs);
    ren.set_scene(&ghosts,&p).unwrap();
    let mut px = vec![[0.5f32;4]; 1920*1080];
    let set=Settings::default();
    ren.composite(frame,&mut px,&set).unwrap();
    ren.set_timing(true);
    ren.take_times();
    let mut p2=p.clone(); p2.scale[0]*=1.0000001; ren.set_scene(&ghosts,&p2).unwrap();
    for _ in 0..1 {ren.composite(frame,&mut px,&set).unwrap();}
    ren.set_timing(false); for _ in 0..1 {let t=std::time::Instant::now(); ren.composite(frame,&mut px,&set).unwrap(); println!("wall {:?}",t.elapsed());}
    let probes: Vec<[i32;2]> = (0..400).map(|_| [(r()*1920.0) as i32,(r()*1080.0) as i32]).chain(p.peaks.clone()).collect();
    println!("   {}", ren.take_times().iter().map(|t| format!("{} {:.1}/{:.1}", t.pass,t.wall_ms,t.gpu_ms.unwrap_or(0.0))).collect::<Vec<_>>().join(", "));
    let got=ren.probe(frame,&probes).unwrap();
    let exact=vglare::reference::direct_at(&ghosts,&probes.iter().map(|&[i,j]| frame.position(i as f64,j as f64)).collect::<Vec<_>>());
    let dd=vglare::compare::compare(&exact,&got); println!("  {:?} {:?} {:?}", probes[dd.worst.0], exact[dd.worst.0], got[dd.worst.0]);
    println!("   measured {:?}", vglare::compare::compare(&exact,&got));
   }
  }
}
