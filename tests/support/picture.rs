//! Renderings for tests: a scene as text or as a world, a pipeline, and the outputs asked for; and where pixels look.
//!
//! All share one adapter; each has a device of its own, so that tests may run side by side.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use glam::DVec3;
use libtest_mimic::Failed;
use luminaire::graph::diagnostic::render;
use luminaire::graph::source::SourceMap;
use luminaire::image_file::LinearImage;
use luminaire::passes::Adapter;
use luminaire::scenes::World;
use luminaire::session::{Problems, RenderRequest, Session};

pub const PBR: &str = "pipelines/pbr.ron";
pub const ALBEDO: &str = "pipelines/albedo.ron";

/// The adapter that all tests share; `None` without a driver.
pub fn adapter() -> Option<&'static Adapter> {
    static ADAPTER: OnceLock<Option<Adapter>> = OnceLock::new();
    ADAPTER.get_or_init(|| Adapter::choose(None).ok()).as_ref()
}

/// Problems as a test's failure.
pub fn shown((problems, sources): Problems) -> Failed {
    render(&problems, &sources, false).into()
}

/// The world of a scene file's text.
pub fn world(text: &str) -> Result<World, Failed> {
    let mut sources = SourceMap::default();
    match luminaire::scenes::load_scene_text("test.ron", text, &mut sources) {
        Ok(loaded) => Ok(loaded.world),
        Err(problems) => Err(shown((problems, sources))),
    }
}

/// What to render, beside the scene.
#[derive(Debug, Clone)]
pub struct Shot {
    pub pipeline: String,
    pub size: [u32; 2],
    pub sets: Vec<(String, String)>,
    pub outputs: Vec<String>,
}

impl Shot {
    /// Square pictures of the shipped pipeline `pbr`, `edge` pixels wide, with small shadow maps.
    pub fn pbr(edge: u32, outputs: &[&str]) -> Shot {
        Shot::of(PBR, [edge, edge], outputs).set("sun_shadow_texels", 512).set("local_shadow_texels", 256)
    }

    pub fn of(pipeline: &str, size: [u32; 2], outputs: &[&str]) -> Shot {
        let outputs = outputs.iter().map(|name| (*name).to_owned()).collect();
        Shot { pipeline: pipeline.to_owned(), size, sets: Vec::new(), outputs }
    }

    /// Sets a parameter; the last of two wins.
    #[allow(clippy::needless_pass_by_value, reason = "calls read better with plain numbers")]
    pub fn set(mut self, name: &str, value: impl ToString) -> Shot {
        self.sets.retain(|(known, _)| known != name);
        self.sets.push((name.to_owned(), value.to_string()));
        self
    }

    pub fn request(&self) -> RenderRequest<'_> {
        RenderRequest {
            pipeline: &self.pipeline,
            size: self.size,
            camera: None,
            sets: &self.sets,
            outputs: Some(&self.outputs),
            timing: false,
            memory_budget: None,
        }
    }

    pub fn session(&self, world: &mut World) -> Result<Session, Failed> {
        self.session_on(adapter().ok_or("no adapter")?, world)
    }

    /// On memory that holds poison until something is written.
    pub fn poisoned_session(&self, world: &mut World) -> Result<Session, Failed> {
        self.session_on(&adapter().cloned().ok_or("no adapter")?.poisoned(), world)
    }

    fn session_on(&self, adapter: &Adapter, world: &mut World) -> Result<Session, Failed> {
        Session::on(adapter, world, &self.request()).map_err(shown)
    }

    /// A world, when nothing changes any more.
    pub fn take_world(&self, world: &mut World) -> Result<BTreeMap<String, LinearImage>, Failed> {
        let mut session = self.session(world)?;
        settle(&mut session)?;
        self.outputs.iter().map(|name| Ok((name.clone(), session.read_output(name).map_err(shown)?))).collect()
    }

    /// A scene file's text.
    pub fn take(&self, scene: &str) -> Result<BTreeMap<String, LinearImage>, Failed> {
        self.take_world(&mut world(scene)?)
    }

    /// The first output.
    pub fn one(&self, scene: &str) -> Result<LinearImage, Failed> {
        let mut images = self.take(scene)?;
        images.remove(&self.outputs[0]).ok_or_else(|| "no output".into())
    }
}

/// Takes shots one after the other in one session. What two in a row have in common is compiled once, so shots with the same constants
/// should follow each other.
#[derive(Default)]
pub struct Series(Option<Session>);

impl Series {
    pub fn take(&mut self, shot: &Shot, scene: &str) -> Result<BTreeMap<String, LinearImage>, Failed> {
        self.take_world(shot, &mut world(scene)?)
    }

    pub fn take_world(&mut self, shot: &Shot, world: &mut World) -> Result<BTreeMap<String, LinearImage>, Failed> {
        let mut session = match self.0.take() {
            Some(mut session) => {
                session.reload(world, &shot.request()).map_err(shown)?;
                session
            }
            None => shot.session(world)?,
        };
        settle(&mut session)?;
        let images = shot.outputs.iter().map(|name| Ok((name.clone(), session.read_output(name).map_err(shown)?))).collect();
        self.0 = Some(session);
        images
    }

    /// The first output.
    pub fn one(&mut self, shot: &Shot, scene: &str) -> Result<LinearImage, Failed> {
        self.take(shot, scene)?.remove(&shot.outputs[0]).ok_or_else(|| "no output".into())
    }
}

/// Renders until nothing changes any more, and tells what ran in each frame but the last, in which nothing did.
pub fn settle(session: &mut Session) -> Result<Vec<Vec<String>>, Failed> {
    let mut frames = Vec::new();
    while !session.render_frame().map_err(shown)?.settled {
        frames.push(session.ran().into_iter().map(str::to_owned).collect());
        if frames.len() > 100_000 {
            return Err(format!("it never settles: {:?} ran in the last frame", frames.last()).into());
        }
    }
    Ok(frames)
}

/// A texel, in double precision.
pub fn texel(image: &LinearImage, x: u32, y: u32) -> [f64; 4] {
    image.texels[(y * image.width + x) as usize].map(f64::from)
}

/// All places of an image, row by row.
pub fn places(image: &LinearImage) -> impl Iterator<Item = (u32, u32)> + use<> {
    let (width, height) = (image.width, image.height);
    (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

/// A camera of a scene file, worked out by itself: +Y is up, `fov` is vertical and in degrees.
#[derive(Debug, Clone, Copy)]
pub struct Eye {
    pub position: DVec3,
    pub target: DVec3,
    pub fov: f64,
}

impl Eye {
    pub fn new(position: [f64; 3], target: [f64; 3], fov: f64) -> Eye {
        Eye { position: position.into(), target: target.into(), fov }
    }

    /// The camera as a scene file has it.
    pub fn ron(&self) -> String {
        let Eye { position: p, target: t, fov } = self;
        format!("cameras: {{ \"eye\": (position: ({}, {}, {}), target: ({}, {}, {}), fov: {fov}) }},", p.x, p.y, p.z, t.x, t.y, t.z)
    }

    /// Where the middle of a pixel looks; not of unit length: its part along the axis is 1.
    pub fn ray(&self, image: &LinearImage, x: u32, y: u32) -> DVec3 {
        let forward = (self.target - self.position).normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let up = right.cross(forward);
        let (width, height) = (f64::from(image.width), f64::from(image.height));
        let half = (self.fov.to_radians() / 2.0).tan();
        let u = (f64::from(x) + 0.5) / width * 2.0 - 1.0;
        let v = 1.0 - (f64::from(y) + 0.5) / height * 2.0;
        forward + right * (u * half * width / height) + up * (v * half)
    }

    /// Where a pixel's ray meets the plane through `point`; `None` if it leads away.
    pub fn on_plane(&self, image: &LinearImage, (x, y): (u32, u32), point: DVec3, normal: DVec3) -> Option<DVec3> {
        let ray = self.ray(image, x, y);
        let along = (point - self.position).dot(normal) / ray.dot(normal);
        (along.is_finite() && along > 0.0).then(|| self.position + ray * along)
    }
}

/// Fails with what was found, unless the numbers agree to a fraction.
pub fn near(what: &str, found: f64, expected: f64, fraction: f64) -> Result<(), Failed> {
    let error = (found - expected).abs();
    if error <= fraction * expected.abs() { Ok(()) } else { Err(format!("{what}: {found} and not {expected}").into()) }
}
