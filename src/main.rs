use vglare::gpu::*; use vglare::plan::*; use vglare::renderer::*; use vglare::scene::*; use vglare::series::Bell; use vglare::frame::*; use glam::DVec2;
fn main() {
  let k = 300; let s=0.1;
  let mut x = 12345u64; let mut r = || { x = x.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (x>>11) as f64/(1u64<<53) as f64 };
  let ghosts: Vec<Ghost> = (0..k).map(|_| Ghost{bell:Bell::Gaussian, center: DVec2::new(r()*4.0-2.0, r()*2.4-1.2), size: DVec2::splat(s*(1.0+r())), radiance:[r(),r(),r()]}).collect();
  let d = Device::open(&[Backend::Egl]).unwrap();
  let frame = Frame::full(1920,1080);
  let mut ren = Renderer::new(&d).unwrap();
  let px = vec![[0.5f32;4]; 1920*1080];
  let set=Settings::default();
    let p = plan(&ghosts,&Request{evaluator:Some(Evaluator::Grid), ..Request::new(frame, 1e-3)}).unwrap();
    ren.set_scene(&ghosts,&p).unwrap(); ren.load(frame,&px).unwrap();

  let cpu = || { let t = std::fs::read_to_string("/proc/self/stat").unwrap(); let f: Vec<&str> = t.split(' ').collect(); f[13].parse::<f64>().unwrap()+f[14].parse::<f64>().unwrap() };
  ren.draw_copy().unwrap(); ren.draw(frame,&set).unwrap(); ren.finish();
  let c0=cpu(); for _ in 0..40 { ren.draw_copy().unwrap(); ren.finish(); }
  let c1=cpu(); for _ in 0..40 { ren.draw(frame,&set).unwrap(); ren.finish(); } let c2=cpu();
  for _ in 0..40 {ren.forget_scene(); ren.set_scene(&ghosts,&p).unwrap(); ren.finish(); } let c3=cpu();
  println!("cpu ms/frame: copy {:.1} draw {:.1} spectrum {:.1} ratio {:.2}", (c1-c0)/4.0,(c2-c1)/4.0,(c3-c2)/4.0,(c3-c1)/(c1-c0));
  ren.set_timing(true); for _ in 0..15 { ren.draw(frame,&set).unwrap(); }
  let mut m: std::collections::BTreeMap<String,Vec<f64>> = Default::default(); for t in ren.take_times() { m.entry(t.pass).or_default().push(t.wall_ms); }
  for (k,mut v) in m { v.sort_by(|a,b|a.total_cmp(b)); print!("{k} {:.1} {:.1}; ", v[0], v[v.len()/2]); } println!();
}
