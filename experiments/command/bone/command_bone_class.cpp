#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "core/base/error.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/drilling/drilling_curriculum.h"

namespace haptrial::experiments {
namespace {

struct BoneClassOptions {
  std::string definition;
  std::string folder;
  std::string out;
  bool overwrite{false};
};

int bone_class(const BoneClassOptions& options) {
  if (std::filesystem::path(options.out).extension() != ".html") {
    throw InputError(fmt::format("{}: is not a page by its name; allowed: .html", options.out));
  }
  write_class_page({options.definition, options.folder, options.out, options.overwrite});
  fmt::print("wrote       {}\n", options.out);
  return 0;
}

}  // namespace

void add_bone_class(CLI::App& bone, int& status) {
  CLI::App* sub =
      subcommand(bone, "class", "Show how everybody stands in a curriculum: a page for a browser",
                 "haptrial bone class curriculum.toml out/sessions --out class.html",
                 {"the page OUT", "guide-bone.md"});
  auto& o = options_of<BoneClassOptions>(*sub, status, bone_class);
  sub->add_option("DEFINITION", o.definition, "Definition with a [curriculum] (.toml)")->required();
  sub->add_option("FOLDER", o.folder, "Folder of the session files")->required();
  sub->add_option("--out", o.out, "New page (.html)")->required();
  sub->add_flag("--overwrite", o.overwrite, "Overwrite an existing page");
}

}  // namespace haptrial::experiments
