// Sounds of drills.

#include "experiments/command/line/command_lines.h"
#include "experiments/command/line/subcommand_internal.h"
#include "experiments/command/tools/tool_commands.h"

namespace haptrial::experiments {

void add_spectrum(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "spectrum", "Make a table of a drill's sound from a recording",
                             "haptrial spectrum drill.wav drill.toml --level free",
                             {"", "algorithms/drill-sound.md"});
  auto& o = options_of<SpectrumOptions>(*sub, status, spectrum);
  sub->add_option("FILE", o.file, "Recording (.wav, .flac, .aiff)")->required();
  sub->add_option("OUT", o.out, "New table (.toml) (default: print only)");
  sub->add_option("--burr", o.burr, "Kind of burr: diamond or cutting (default: cutting)");
  sub->add_option("--level", o.level,
                  "Name of the level; 'free' for the drill in the air (default: typical)");
  sub->add_option("--force", o.force, "Force of the burr on the bone [N] (default: 0)");
  sub->add_option("--peaks", o.peaks, "Largest number of peaks (default: 24)");
  sub->add_option("--segment", o.segment,
                  "Samples in a segment, a power of two (default: 40 ms or more)");
  sub->add_flag("--add", o.add, "Add the level to an existing table");
  sub->add_option("--wav", o.wav, "New sound file made from the peaks (.wav)");
  sub->add_option("--picture", o.picture, "New picture of both spectra (.png, .svg)");
  sub->add_flag("--overwrite", o.overwrite, "Overwrite existing files");
}

}  // namespace haptrial::experiments
