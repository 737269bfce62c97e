#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "core/base/toml_text.h"
#include "core/base/whole_file.h"
#include "core/bone/data/anatomy.h"
#include "core/bone/data/bone_summary.h"
#include "experiments/command/bone/bone_options.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct BoneStructuresOptions : BoneInput, BoneOutput {
  std::string table;
};

void list(const bone::BoneModel& model, const bone::BoneSummary& summary) {
  fmt::print("{:5} {:28} {:>10} {:>11}  {}\n", "label", "structure", "voxels", "mm3", "name");
  for (const bone::StructureSummary& one : summary.structures) {
    const bone::Structure& structure = model.structures[one.label];
    const std::string words = !bone::is_known_structure(structure.name)
                                  ? fmt::format("unknown; the nearest known name is '{}'",
                                                bone::nearest_structure(structure.name))
                              : structure.vital ? "known, vital"
                                                : "known";
    fmt::print("{:5} {:28} {:10} {:11.1f}  {}\n", one.label, structure.name, one.voxels,
               1e9 * one.volume, words);
  }
  if (!bone::has_vital_structures(model)) {
    fmt::print("WARNING: vital structures are unknown: no injury can be told in this bone\n");
  }
}

/// A table for --labels: names that are not known with the nearest known ones, to be looked over.
std::string table_of(const bone::BoneModel& model, const bone::BoneSummary& summary) {
  std::string table =
      "# Names of a bone's structures, for --labels. Look each over: the right side is a guess.\n"
      "[names]\n";
  for (const bone::StructureSummary& one : summary.structures) {
    const std::string& name = model.structures[one.label].name;
    if (!bone::is_known_structure(name)) {
      table += fmt::format("{} = {}\n", toml_text(name), toml_text(bone::nearest_structure(name)));
    }
  }
  return table;
}

int bone_structures(const BoneStructuresOptions& options) {
  const MemoryBudget budget(options.max_memory);
  if (!options.out.empty()) {
    check_new_bone(options);
  }
  const bone::LoadOptions load = load_options(options, budget);
  const bone::BoneModel model = [&] {
    ShownWork work("reading");
    return bone::load_bone(options.in, load, work.report());
  }();
  const bone::BoneSummary summary = bone::summary_of(model);
  list(model, summary);
  if (!options.table.empty()) {
    WholeFile file(options.table, options.overwrite);
    file.write(table_of(model, summary));
    file.finish();
    fmt::print("wrote       {}\n", options.table);
  }
  if (!options.out.empty()) {
    save_new_bone(options, model);
  }
  return 0;
}

}  // namespace

void add_bone_structures(CLI::App& bone, int& status) {
  CLI::App* sub =
      subcommand(bone, "structures", "List structures and name them anew",
                 "haptrial bone structures ear.nrrd --labels names.toml --out named.nrrd",
                 {"", "guide-scan.md"});
  auto& o = options_of<BoneStructuresOptions>(*sub, status, bone_structures);
  sub->add_option("IN", o.in, "Bone or volume with labels (.nrrd, .nhdr, .nii, .nii.gz)")
      ->required();
  sub->add_option("--labels", o.labels, "Names of labels (.toml)");
  sub->add_option("--out", o.out, "New bone under these names (.nrrd)");
  sub->add_option("--table", o.table,
                  "New table of names that are not known, with guesses, for --labels (.toml)");
  sub->add_option("--max-memory", o.max_memory, kMemoryHelp);
  sub->add_flag("--overwrite", o.overwrite, "Overwrite existing files");
}

}  // namespace haptrial::experiments
