#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "experiments/preview/asked_pages.h"
#include "experiments/preview/preview.h"
#include "experiments/preview/tried_trial.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {
namespace {

struct ShowOptions {
  std::string definition;
  std::string out;
  int trial{1};
  std::string seed{"1"};
  std::string language;
  bool no_virtual_trial{false};
  std::string headings;
  std::vector<double> through;
  std::string plane;
  bool tried{false};
  bool pages{false};
};

std::filesystem::path preview_file(const ShowOptions& options) {
  if (options.out.empty()) {
    return std::filesystem::path(options.definition).stem().string() + "-preview.html";
  }
  std::filesystem::path page(options.out);
  if (page.extension() != ".html") {
    throw InputError(fmt::format("--out is '{}'; allowed: a name that ends in .html", options.out));
  }
  return page;
}

/// @throws InputError for numbers that are not finite
protocols::FeltLook look_of(const ShowOptions& options) {
  protocols::FeltLook look;
  if (!options.through.empty()) {
    look.through = Eigen::Vector3d(options.through[0], options.through[1], options.through[2]);
    if (!look.through->allFinite() || look.through->norm() > 1.0) {
      throw InputError("--through is not a place; allowed: three numbers within 1 m");
    }
  }
  if (!options.plane.empty()) {
    look.plane = {options.plane[0] - 'x', options.plane[1] - 'x'};
  }
  return look;
}

/// Answers the lines of a pointer that tries the trial.
int try_trial(const ShowOptions& options) {
  const PreviewRequest request{options.trial, checked_seed(options.seed), false, {}, {}};
  const Experiment experiment = load_experiment(options.definition, options.language);
  const auto trial = experiment.study->tried_trial(*experiment.definition, request);
  if (!trial) {
    throw InputError(fmt::format(
        "trials of the protocol {} cannot be tried so; in a window: haptrial run {} --pilot "
        "--device mouse --window",
        experiment.definition->protocol, options.definition));
  }
  try_lines(*trial, std::cin, std::cout);
  return 0;
}

int show(const ShowOptions& options) {
  if (options.pages) {
    answer_page_requests(std::cin, std::cout);
    return 0;
  }
  if (options.tried) {
    return try_trial(options);
  }
  const std::filesystem::path page = preview_file(options);
  const PreviewRequest request{options.trial, checked_seed(options.seed), !options.no_virtual_trial,
                               options.headings, look_of(options)};
  const Experiment experiment = load_experiment(options.definition, options.language);
  write_whole(page, preview_of(experiment, request).html());
  fmt::print("preview: {}\n", page.string());
  return 0;
}

}  // namespace

void add_show(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "show",
                             "Show an experiment before anybody runs it, as one page for a browser",
                             "haptrial show first_experiment --out preview.html",
                             {"an HTML file that needs nothing else", "guide-own-experiment.md"});
  auto& o = options_of<ShowOptions>(*sub, status, show);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("--out", o.out, "The page to be written (default: NAME-preview.html)");
  sub->add_option("--trial", o.trial,
                  with_default("Number of the trial in the first session, practice included",
                               std::to_string(o.trial)));
  sub->add_option("--seed", o.seed, with_default("Seed of every random number", o.seed));
  sub->add_option("--language", o.language,
                  "Language of what participants read, such as de (default: the definition's)");
  sub->add_flag("--no-virtual-trial", o.no_virtual_trial,
                "Leave out the trial of a virtual participant");
  sub->add_option("--headings", o.headings,
                  "Language of the page's headings and controls (default: en)")
      ->check(CLI::IsMember({"en", "de"}));
  sub->add_option("--through", o.through,
                  "Place X Y Z through which forces are drawn [m] (default: the start)")
      ->expected(3);
  sub->add_option("--plane", o.plane,
                  "Plane in which forces are drawn (default: where they change most)")
      ->check(CLI::IsMember({"xy", "xz", "yz"}));
  sub->add_flag("--try", o.tried,
                "Write no page, but answer places of a pointer on standard input by the forces of "
                "the trial, a line each (guide-studio.md)");
  sub->add_flag("--pages", o.pages,
                "Make the pages that lines on standard input ask for, in place of DEFINITION's "
                "(guide-studio.md)");
}

}  // namespace haptrial::experiments
