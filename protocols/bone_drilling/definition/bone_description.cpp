#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/counted.h"
#include "core/base/definition/table.h"
#include "core/bone/nerve/nerve_rows.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/definition/contact_margin.h"

namespace haptrial::protocols {
namespace {

/// Friction of the device brings a burr to rest that would swing without it; no law tells how much
/// friction is enough (docs/algorithms/bone-feel.md), so only its absence is warned about.
void warn_of_contact(const BoneDefinition& d, std::vector<std::string>& warnings) {
  const auto margin = contact_margin(d);
  if (margin && margin->stiffness > margin->stable && d.hand.coulomb_friction == 0.0) {
    warnings.push_back(fmt::format(
        "hand.coulomb_friction is 0; flat bone under the burr {} is {:.1f} N/mm stiff "
        "at {:g} N, the loop carries {:.1f} N/mm at {:g} Hz, and the burr will not come "
        "to rest",
        margin->tool, 1e-3 * margin->stiffness, margin->force, 1e-3 * margin->stable, d.rate));
  }
}

/// Lines at half the rate and above are left out of the vibration.
void warn_of_vibration(const BoneDefinition& d, std::vector<std::string>& warnings) {
  double highest = 0.0;
  for (const auto& kind : d.vibration_table.kinds) {
    for (const auto* levels : {&kind.free, &kind.contact}) {
      for (const sound::Level& level : *levels) {
        for (int i = 0; i < level.spectrum.count; ++i) {
          highest = std::max(highest, level.spectrum.peaks[static_cast<std::size_t>(i)].frequency);
        }
      }
    }
  }
  if (d.vibration_gain > 0.0 && highest >= 0.5 * d.rate) {
    warnings.push_back(
        fmt::format("the vibration has lines of up to {:.0f} Hz; those at {:g} Hz and above, half "
                    "of experiment.rate, are left out",
                    highest, 0.5 * d.rate));
  }
}

void warn_of_devices(const BoneDefinition& d, std::vector<std::string>& warnings) {
  if (d.drilling.second && d.nerves) {
    warnings.emplace_back(
        "the nerve monitor watches the tool of the first hand alone: a tube of second_hand that "
        "touches or sucks at a nerve makes no burst, and is in no count of them");
  }
  Table root = d.root();
  const auto check = [&](const char* table, double max_force) {
    if (root.has(table) && max_force < d.drilling.force_limit) {
      warnings.push_back(
          fmt::format("{0}.max_force is {1:g} N; drilling.force_limit is {2:g} N, and contact "
                      "forces above {1:g} N will be cut off with that device",
                      table, max_force, d.drilling.force_limit));
    }
  };
  for (const device::VendorDevice& vendor : device::vendor_devices()) {
    check(vendor.table, vendor.limits(d.vendor).max_force);
  }
}

/// "shown in every other one", or what stands for none.
std::string words_on(const char* verb, const GivenIn& in, const char* none) {
  return in.trials == GivenIn::kNone ? none
                                     : fmt::format("{} {}", verb, given_text(in, "procedure"));
}

std::string describe_nerves(const BoneDefinition& d) {
  std::vector<std::string> names;
  for (const nerve::WatchedNerve& nerve : d.nerves->nerves) {
    names.push_back(nerve.name);
  }
  const std::string heard = words_on("heard", d.nerves->heard, "not heard");
  return fmt::format("nerve monitor (a model, no clinical claim): {}; {} at {:g} Hz, {}",
                     fmt::join(names, ", "), counted(d.nerves->channels(), "channel", "channels"),
                     d.nerves->monitor.rate, heard);
}

std::string describe_hints(const BoneDefinition& d) {
  const hint::HintSetup& setup = *d.hints;
  std::vector<std::string_view> kinds;
  for (const auto kind : hint::kAllHintKinds) {
    if (setup.gives(kind)) {
      kinds.push_back(hint::name_of(kind));
    }
  }
  const std::string shown = words_on("shown", setup.shown, "recorded but not shown");
  const std::string from =
      setup.file.empty() ? ""
                         : fmt::format("; safe values of {} ({} of {})",
                                       counted(setup.limits.participants, "expert", "experts"),
                                       setup.file, setup.limits.study);
  std::string judged;
  for (std::size_t n = 0; n < d.hint_maps.size() && setup.needs_limits(); ++n) {
    judged +=
        fmt::format("; in {} near {}", d.bones[n]->name, fmt::join(d.hint_maps[n]->judged(), ", "));
  }
  return fmt::format("hints: {}, {}{}{}", fmt::join(kinds, ", "), shown, from, judged);
}

std::string describe_regions(const bone::RegionSetup& setup) {
  const std::string given =
      setup.given.trials == GivenIn::kNone ? "recorded only" : given_text(setup.given, "procedure");
  const std::string how =
      setup.kind == bone::RegionKind::kSound
          ? "a chime"
          : fmt::format("{:g} N/m up to {:g} N and a chime", setup.spring(), setup.most_force());
  return fmt::format("forbidden: burrs within {:g} mm of {}; {}, {}", 1e3 * setup.margin,
                     fmt::join(setup.structures, ", "), how, given);
}

/// Whoever is hinted at by programs should know.
void warn_of_hints(const BoneDefinition& d, std::vector<std::string>& warnings) {
  if (d.hints && d.hints->limits.simulated) {
    warnings.push_back(fmt::format(
        "hints.file {} was learned from simulated experts: its safe values prove nothing about "
        "surgeons",
        d.hints->file));
  }
}

/// A page is written only after the session: too late for a file that is not there.
void warn_of_feedback(const BoneDefinition& d, std::vector<std::string>& warnings) {
  for (const std::string& file : d.absent_files) {
    warnings.push_back(
        fmt::format("{}: no such file or folder; without it no page is written", file));
  }
}

/// The cases that a trainee of a group has done at the end who passes every procedure. A session is
/// of one case.
std::size_t cases_at_best(const BoneDefinition& d, const std::string& group) {
  const std::vector<bone::CurriculumCase>& cases = d.curriculum->cases;
  std::size_t done = 0;
  int passed = 0;
  for (int session = 1; session <= d.sessions() && done < cases.size(); ++session) {
    passed += d.comes(session, group) ? d.procedures_in(session) : 0;
    if (passed >= cases[done].in_a_row) {
      ++done;
      passed = 0;
    }
  }
  return done;
}

void warn_of_curriculum(const BoneDefinition& d, std::vector<std::string>& warnings) {
  if (!d.curriculum) {
    return;
  }
  std::size_t most = 0;
  for (const StudyGroup& group : d.groups) {
    most = std::max(most, cases_at_best(d, group.name));
  }
  if (most < d.curriculum->cases.size()) {
    warnings.push_back(fmt::format(
        "design.sessions and design.procedures are enough for {} of the {} cases of the "
        "curriculum, each with sessions of its own, even if every procedure passes: nobody can "
        "finish it",
        most, d.curriculum->cases.size()));
  }
}

void warn_of_bones(const BoneDefinition& d, std::vector<std::string>& warnings) {
  for (const auto& bone : d.bones) {
    for (const std::string& note : bone->notes) {
      warnings.push_back(fmt::format("bone {}: {}", bone->name, note));
    }
  }
}

}  // namespace

std::vector<std::string> BoneDefinition::warnings() const {
  const BoneDefinition& d = *this;
  std::vector<std::string> warnings;
  warn_of_bones(d, warnings);
  warn_of_contact(d, warnings);
  warn_of_vibration(d, warnings);
  warn_of_devices(d, warnings);
  warn_of_hints(d, warnings);
  warn_of_feedback(d, warnings);
  warn_of_curriculum(d, warnings);
  return warnings;
}

std::vector<ButtonUse> BoneDefinition::button_uses() const {
  constexpr std::size_t kDrill = 0, kTube = 1;  // devices
  std::vector<ButtonUse> uses;
  for (std::size_t f = 0; f < bone::kFunctions; ++f) {
    uses.push_back({fmt::format("buttons.{}", bone::name_of(static_cast<bone::Function>(f))),
                    drilling.controls.buttons[f], "", kDrill});
  }
  if (drilling.second) {
    uses.push_back({"second_hand.suck", drilling.second->suck, "", kTube});
    uses.push_back({"second_hand.rinse", drilling.second->rinse, "", kTube});
  }
  return uses;
}

PedalUse BoneDefinition::pedal_use() const {
  return drilling.controls.analog_power ? PedalUse::kBeside : PedalUse::kNone;
}

std::vector<std::string> BoneDefinition::description() const {
  std::vector<std::string> lines{
      fmt::format("{}: {}, {} of at most {:.0f} s{}, {} Hz", name,
                  counted(design.participants, "participant", "participants"),
                  counted(design.trials, "procedure", "procedures"), drilling.time_limit,
                  design.trials == 1 ? "" : " each", rate)};
  for (const auto& bone : bones) {
    const auto filled = std::count_if(bone->labels.begin(), bone->labels.end(),
                                      [](std::uint8_t label) { return label != 0; });
    lines.push_back(fmt::format("bone: {}, {} x {} x {} voxels of {:.3g} mm, {} of them filled",
                                bone->name, bone->grid.size[0], bone->grid.size[1],
                                bone->grid.size[2], 1e3 * bone->grid.spacing, filled));
  }
  std::vector<std::string> tools;
  for (const bone::ToolSpec& tool : simulator.tools) {
    tools.push_back(tool.name);
  }
  lines.push_back(fmt::format("tools: {}", fmt::join(tools, ", ")));
  for (const bone::SoftTissueParameters& soft : simulator.soft_tissue) {
    // A held spring gives k T² v² / 2 a tick, which damping takes up above k T / 2.
    lines.push_back(fmt::format(
        "soft: {} gives way with {:g} N/m, tears at {:g} N, comes off a tube at {:g} N; stays calm "
        "with {:.2g} N·s/m of damping, and the hand of [hand] has {:g}",
        soft.structure, soft.stiffness, soft.tears_at, soft.suction, 0.5 * soft.stiffness / rate,
        hand.damping));
  }
  if (curriculum) {
    std::vector<std::string> names;
    for (const bone::CurriculumCase& each : curriculum->cases) {
      names.push_back(each.name);
    }
    lines.push_back(
        fmt::format("curriculum: {}; which case a session is of follows from the "
                    "sessions before it",
                    fmt::join(names, ", ")));
  }
  if (nerves) {
    lines.push_back(describe_nerves(*this));
  }
  if (hints) {
    lines.push_back(describe_hints(*this));
  }
  if (forbidden) {
    lines.push_back(describe_regions(*forbidden));
  }
  if (!bones.empty() &&
      (beginning.planned_to > 0.0 || std::any_of(sources.begin(), sources.end(), is_session))) {
    lines.push_back(fmt::format("begins with: {}", bones.front()->source));
  }
  if (const auto margin = contact_margin(*this)) {
    lines.push_back(describe(*margin));
  }
  return lines;
}

std::vector<stream::SideStream> BoneDefinition::side_streams() const {
  if (!nerves) {
    return {};
  }
  const double hertz = nerves->monitor.rate;
  stream::SideStream emg{"nerves", "EMG", "V", {}, hertz, {{"model", "simulated electromyogram"}},
                         {}};
  for (const nerve::WatchedNerve& nerve : nerves->nerves) {
    emg.channels.insert(emg.channels.end(), nerve.channels.begin(), nerve.channels.end());
  }
  emg.read = stream::reads_rows<record::EmgRow>([hertz](const record::EmgRow& row) {
    return stream::SideSample{row.sequence, static_cast<double>(row.sample) / hertz, row.channels};
  });
  return {emg};
}

std::vector<std::string> BoneDefinition::left_out_of_dry_runs() const {
  return practice > 0.0
             ? std::vector{fmt::format("{} of practice left out: virtual subjects need none",
                                       planned_minutes(practice))}
             : std::vector<std::string>{};
}

}  // namespace haptrial::protocols
