//! Adapters and devices: which one is used, what it can do, and opening it.
//!
//! An [`Adapter`] is chosen first, since the planner needs its [`DeviceFacts`]; a [`Gpu`] is opened when the plan's
//! requirements are known, with those features and no others, so that a pipeline can't come to rely on one by accident.
//!
//! Accepted downside: another pipeline on the same adapter needs a device of its own if it requires more.

use luminaire_graph::device::DeviceFacts;
use luminaire_graph::diagnostic::{Diagnostic, list_names};
use luminaire_graph::plan::Requirement;

use crate::errors::{ErrorSink, block_on};
use crate::facts::{facts, limits_of, wgpu_feature, wgpu_features};

/// The variable that names the adapter to use: a part of its name, in any case.
pub const ADAPTER_VARIABLE: &str = "LUMINAIRE_ADAPTER";

/// Bytes that a plan may allocate unless said otherwise: 4 GiB.
pub const DEFAULT_MEMORY_BUDGET: u64 = 4 << 30;

/// How to open a device.
#[derive(Debug, Clone, Default)]
pub struct GpuOptions {
    /// Features that the plan needs, see [`luminaire_graph::plan::Plan::requirements`].
    pub requirements: Vec<Requirement>,
    /// Measure GPU time per pass where the adapter can. Waits for the GPU after every frame.
    pub timing: bool,
    /// A device that computes nothing, with these limits and features, instead of an adapter.
    pub noop: Option<DeviceFacts>,
    /// Bytes that a plan may allocate; [`DEFAULT_MEMORY_BUDGET`] unless said.
    pub memory_budget: Option<u64>,
    /// For tests, see [`Adapter::poisoned`].
    pub poison: bool,
}

/// A GPU, or a program that behaves like one, not opened yet.
#[derive(Debug, Clone)]
pub struct Adapter {
    instance: wgpu::Instance,
    adapter: wgpu::Adapter,
    name: String,
    memory_budget: u64,
    poison: bool,
}

impl Adapter {
    fn new(instance: &wgpu::Instance, adapter: wgpu::Adapter, memory_budget: u64) -> Adapter {
        let name = adapter.get_info().name;
        Adapter { instance: instance.clone(), adapter, name, memory_budget, poison: false }
    }

    /// The best Vulkan adapter: discrete before integrated before virtual before software, then as the driver lists them.
    /// [`ADAPTER_VARIABLE`] overrides that. Error `device::no-adapter`.
    pub fn choose(memory_budget: Option<u64>) -> Result<Adapter, Vec<Diagnostic>> {
        let wanted = std::env::var(ADAPTER_VARIABLE).ok().filter(|wanted| !wanted.is_empty());
        let (instance, adapters) = enumerate();
        let names: Vec<String> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
        let kinds: Vec<wgpu::DeviceType> = adapters.iter().map(|adapter| adapter.get_info().device_type).collect();
        match best(&names, &kinds, wanted.as_deref()).and_then(|index| adapters.into_iter().nth(index)) {
            Some(adapter) => Ok(Adapter::new(&instance, adapter, memory_budget.unwrap_or(DEFAULT_MEMORY_BUDGET))),
            None => Err(vec![no_adapter(&names, wanted.as_deref())]),
        }
    }

    /// An adapter that computes nothing and offers what the facts say.
    pub fn noop(facts: &DeviceFacts) -> Result<Adapter, Vec<Diagnostic>> {
        let noop = wgpu::NoopBackendOptions {
            limits: Some(limits_of(facts)),
            features: Some(wgpu_features(facts.features.iter().copied())),
            ..wgpu::NoopBackendOptions::enabled()
        };
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::NOOP,
            backend_options: wgpu::BackendOptions { noop, ..wgpu::BackendOptions::default() },
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        match block_on(instance.enumerate_adapters(wgpu::Backends::NOOP)).into_iter().next() {
            Some(adapter) => Ok(Adapter { instance, adapter, name: facts.name.clone(), memory_budget: facts.memory_budget, poison: false }),
            None => Err(vec![Diagnostic::error("device::no-adapter", "the noop adapter is not there")]),
        }
    }

    /// The same adapter for tests: on its devices every memory is poisoned when it is made, and again whenever a resource takes
    /// bytes over from another one, so that whatever relies on leftovers shows (NaN, magenta, all ones). Slow, and of no use
    /// otherwise: the results are the same.
    pub fn poisoned(self) -> Adapter {
        Adapter { poison: true, ..self }
    }

    /// The adapter's name, for messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What the planner must know.
    pub fn facts(&self) -> DeviceFacts {
        facts(&self.name, &self.adapter.limits(), self.adapter.features(), self.memory_budget)
    }

    /// Name, kind, driver and backend, for people: one fact each.
    pub fn describe(&self) -> Vec<(&'static str, String)> {
        let info = self.adapter.get_info();
        vec![
            ("adapter", info.name),
            ("kind", kind_name(info.device_type).to_owned()),
            ("driver", format!("{} {}", info.driver, info.driver_info).trim().to_owned()),
            ("backend", info.backend.to_string()),
        ]
    }

    /// How many objects of each kind wgpu holds for all devices that were opened through this adapter or its kin (adapters that
    /// were listed together); to see that a long run leaves nothing behind.
    pub fn objects(&self) -> Vec<(&'static str, usize)> {
        let Some(report) = self.instance.generate_report() else { return Vec::new() };
        let hub = report.hub_report();
        let registries = [
            ("devices", &hub.devices),
            ("queues", &hub.queues),
            ("pipeline layouts", &hub.pipeline_layouts),
            ("shader modules", &hub.shader_modules),
            ("bind group layouts", &hub.bind_group_layouts),
            ("bind groups", &hub.bind_groups),
            ("command encoders", &hub.command_encoders),
            ("command buffers", &hub.command_buffers),
            ("render pipelines", &hub.render_pipelines),
            ("compute pipelines", &hub.compute_pipelines),
            ("query sets", &hub.query_sets),
            ("buffers", &hub.buffers),
            ("textures", &hub.textures),
            ("texture views", &hub.texture_views),
            ("samplers", &hub.samplers),
        ];
        registries.map(|(kind, registry)| (kind, registry.num_kept_from_user)).to_vec()
    }

    /// Opens a device with the required features, timestamps if `timing` and the adapter has them, and all of the adapter's
    /// limits. Errors: `device::missing-feature` for each requirement that the adapter lacks, `device::cannot-open`.
    pub fn open(&self, requirements: &[Requirement], timing: bool) -> Result<Gpu, Vec<Diagnostic>> {
        let offered = self.adapter.features();
        let name = &self.name;
        let missing: Vec<Diagnostic> = requirements
            .iter()
            .filter(|requirement| !offered.contains(wgpu_feature(requirement.feature)))
            .map(|requirement| missing_feature(requirement, name))
            .collect();
        if !missing.is_empty() {
            return Err(missing);
        }
        let mut features = wgpu_features(requirements.iter().map(|requirement| requirement.feature));
        if timing {
            features |= offered & wgpu::Features::TIMESTAMP_QUERY;
        }
        let request = self.adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("luminaire"),
            required_features: features,
            required_limits: self.adapter.limits(),
            ..wgpu::DeviceDescriptor::default()
        });
        let (device, queue) = block_on(request)
            .map_err(|error| vec![Diagnostic::error("device::cannot-open", format!("the adapter `{name}` can't be opened: {error}"))])?;
        let errors = ErrorSink::default();
        errors.install(&device);
        let facts = facts(name, &device.limits(), device.features(), self.memory_budget);
        Ok(Gpu { device, queue, errors, facts, poison: self.poison })
    }
}

/// Every Vulkan adapter, in the order in which [`Adapter::choose`] prefers them.
pub fn adapters() -> Vec<Adapter> {
    let (instance, mut all) = enumerate();
    all.sort_by_key(|adapter| rank(adapter.get_info().device_type));
    all.into_iter().map(|adapter| Adapter::new(&instance, adapter, DEFAULT_MEMORY_BUDGET)).collect()
}

/// An open device. Clones share it.
#[derive(Debug, Clone)]
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) errors: ErrorSink,
    facts: DeviceFacts,
    /// Memories are poisoned, see [`Adapter::poisoned`].
    pub(crate) poison: bool,
}

impl Gpu {
    /// Chooses an adapter and opens it.
    pub fn open(options: &GpuOptions) -> Result<Gpu, Vec<Diagnostic>> {
        let adapter = match &options.noop {
            Some(facts) => Adapter::noop(facts)?,
            None => Adapter::choose(options.memory_budget)?,
        };
        let adapter = if options.poison { adapter.poisoned() } else { adapter };
        adapter.open(&options.requirements, options.timing)
    }

    /// What the open device offers: the adapter's limits, and only the features that were asked for.
    pub fn facts(&self) -> &DeviceFacts {
        &self.facts
    }

    /// The device, for those who draw beside the executor (a viewer).
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// The queue of the device.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Bytes that stand on the device; `None` where its allocator does not say.
    pub fn allocated_bytes(&self) -> Option<u64> {
        self.device.generate_allocator_report().map(|report| report.total_allocated_bytes)
    }

    /// Waits until the device has done all that was submitted.
    pub(crate) fn wait(&self) -> Result<(), Diagnostic> {
        self.poll(wgpu::PollType::wait_indefinitely())
    }

    /// Whether the device still stands. wgpu takes work for a lost device in silence and tells only those who poll.
    pub(crate) fn check_alive(&self) -> Result<(), Diagnostic> {
        self.poll(wgpu::PollType::Poll)
    }

    fn poll(&self, poll: wgpu::PollType) -> Result<(), Diagnostic> {
        let polled = self.device.poll(poll);
        if let Some(lost) = self.errors.lost() {
            return Err(lost);
        }
        polled.map(|_| ()).map_err(|error| Diagnostic::error("execute::device-lost", format!("waiting for the device failed: {error}")))
    }
}

fn enumerate() -> (wgpu::Instance, Vec<wgpu::Adapter>) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::VULKAN,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapters = block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
    (instance, adapters)
}

fn rank(kind: wgpu::DeviceType) -> u32 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Cpu => 3,
        wgpu::DeviceType::Other => 4,
    }
}

fn kind_name(kind: wgpu::DeviceType) -> &'static str {
    match kind {
        wgpu::DeviceType::DiscreteGpu => "discrete GPU",
        wgpu::DeviceType::IntegratedGpu => "integrated GPU",
        wgpu::DeviceType::VirtualGpu => "virtual GPU",
        wgpu::DeviceType::Cpu => "software",
        wgpu::DeviceType::Other => "unknown",
    }
}

/// The index of the adapter to use.
fn best(names: &[String], kinds: &[wgpu::DeviceType], wanted: Option<&str>) -> Option<usize> {
    let fits = |name: &String| wanted.is_none_or(|wanted| name.to_lowercase().contains(&wanted.to_lowercase()));
    (0..names.len()).filter(|index| fits(&names[*index])).min_by_key(|index| rank(kinds[*index]))
}

fn no_adapter(names: &[String], wanted: Option<&str>) -> Diagnostic {
    let install = "on Debian or Ubuntu, `apt-get install mesa-vulkan-drivers` installs drivers, among them one that needs no GPU";
    match wanted {
        Some(wanted) if !names.is_empty() => {
            Diagnostic::error("device::no-adapter", format!("no Vulkan adapter has `{wanted}` in its name ({ADAPTER_VARIABLE})"))
                .hint(format!("the adapters are {}", list_names(names.iter().map(String::as_str))))
        }
        _ => Diagnostic::error("device::no-adapter", "there is no Vulkan adapter on this machine").hint(install),
    }
}

fn missing_feature(requirement: &Requirement, adapter: &str) -> Diagnostic {
    let feature = requirement.feature.name();
    let message = format!("pass `{}` needs the feature `{feature}` {}, and `{adapter}` lacks it", requirement.pass, requirement.why);
    Diagnostic::error("device::missing-feature", message)
        .at(requirement.span, format!("needs `{feature}`"))
        .hint(format!("choose another adapter with {ADAPTER_VARIABLE}, or another format"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_discrete_gpu_comes_first_and_a_name_overrides() {
        let names: Vec<String> = ["llvmpipe", "Arc A380", "Iris"].map(str::to_owned).to_vec();
        let kinds = [wgpu::DeviceType::Cpu, wgpu::DeviceType::DiscreteGpu, wgpu::DeviceType::IntegratedGpu];
        assert_eq!(best(&names, &kinds, None), Some(1));
        assert_eq!(best(&names, &kinds, Some("LLVM")), Some(0));
        assert_eq!(best(&names, &kinds, Some("nvidia")), None);
        assert!(no_adapter(&names, Some("nvidia")).hint.is_some_and(|hint| hint.contains("`Iris`")));
        assert!(no_adapter(&[], None).hint.is_some_and(|hint| hint.contains("mesa-vulkan-drivers")));
    }

    #[test]
    fn a_missing_feature_names_pass_feature_and_adapter() {
        let requirement = Requirement {
            feature: luminaire_graph::device::Feature::ShaderF16,
            pass: "shade".into(),
            span: luminaire_graph::source::Span::NOWHERE,
            why: "for 16-bit floats".to_owned(),
        };
        let options = GpuOptions { requirements: vec![requirement], noop: Some(DeviceFacts::webgpu_defaults()), ..GpuOptions::default() };
        let problems = Gpu::open(&options).unwrap_err();
        assert_eq!(problems.len(), 1);
        assert_eq!(problems[0].code, "device::missing-feature");
        assert!(problems[0].message.contains("`shade`") && problems[0].message.contains("`shader-f16`"), "{}", problems[0].message);
    }
}
