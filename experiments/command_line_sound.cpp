// Sounds of drills.

#include "experiments/command_line_internal.h"

namespace haptrial::experiments {

void add_spectrum(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "spectrum", "Make a table of a drill's sound from a recording",
                             "haptrial spectrum drill.wav drill.toml --level free");
  auto& o = options_of<SpectrumOptions>(*sub, status, spectrum);
  sub->add_option("FILE", o.file, "Recording (.wav, .flac, .aiff)")->required();
  sub->add_option("OUT", o.out, "New table (.toml); printed only by default");
  sub->add_option("--burr", o.burr, "diamond or cutting (cutting)");
  sub->add_option("--level", o.level,
                  "Name of the level; 'free': the drill is in the air (typical)");
  sub->add_option("--force", o.force, "With which the burr pressed on bone [N] (0)");
  sub->add_option("--peaks", o.peaks, "At most so many (24)");
  sub->add_option("--segment", o.segment,
                  "Samples in a segment, a power of two; 40 ms or more by default");
  sub->add_flag("--add", o.add, "Add the level to the table that is there");
  sub->add_option("--wav", o.wav, "Also make a new sound from the peaks (.wav)");
  sub->add_option("--picture", o.picture, "Draw both spectra (.png, .svg)");
  sub->add_flag("--overwrite", o.overwrite, "Replace files that are there");
}

}  // namespace haptrial::experiments
