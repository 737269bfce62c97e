#include "experiments/commands.h"

#include <fmt/format.h>

#include "core/record/integrity.h"
#include "core/record/session_reader.h"

namespace haptrial::experiments {

int info(const std::string& file) {
  const record::SessionReader reader(file);
  const record::SessionInfo& i = reader.info();
  const record::Integrity integrity = record::check_session(reader);
  fmt::print("subject     {}{}\n", i.subject, i.simulated ? " (simulated)" : "");
  fmt::print("definition  {}, seed {}\n", i.definition_name, i.seed);
  fmt::print("recorded    {}, haptrial {} ({})\n", i.start_utc, i.program_version,
             i.program_commit);
  fmt::print("device      {}, {} N, workspace radius {} m\n", i.device, i.device_max_force,
             i.device_workspace_radius);
  fmt::print("clock       {}, {} Hz\n", i.clock, i.rate);
  fmt::print("rows        {}, sequence {} to {}, {} gaps\n", integrity.rows,
             integrity.first_sequence, integrity.last_sequence, integrity.gaps);
  fmt::print("passes      {}, {} aborted\n", integrity.passes, integrity.aborted);
  if (reader.timing_summary()) {
    fmt::print("loop        {} overruns, {} records dropped\n", integrity.overruns,
               integrity.dropped);
  } else {
    fmt::print("loop        unknown: the session did not come to its end\n");
  }
  for (const record::EventRow& event : reader.events()) {
    if (event.kind == "aborted" || event.kind == "interrupted" || event.kind == "notice") {
      fmt::print("{:<11} at {:.3f} s: {}\n", event.kind, 1e-9 * static_cast<double>(event.time_ns),
                 event.text);
    }
  }
  for (const std::string& problem : integrity.problems) {
    fmt::print("problem     {}\n", problem);
  }
  fmt::print("{}\n", integrity.ok ? "complete: every tick is recorded" : "NOT complete");
  return integrity.ok ? 0 : 1;
}

}  // namespace haptrial::experiments
