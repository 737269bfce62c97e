#include "analysis/force_training/exchange/export_curves.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "analysis/files/delimited.h"
#include "analysis/files/new_folder.h"
#include "analysis/force_training/study/session_recalls.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"

namespace haptrial::exchange {
namespace {

namespace fs = std::filesystem;

void refuse_second_sessions(const std::vector<ExportSession>& sessions) {
  for (const auto& session : sessions) {
    if (session.number > 1) {
      throw InputError(fmt::format(
          "{}: is another session of subject {}; give one session file for each subject",
          session.file.string(), session.info.subject));
    }
  }
}

std::string curves_text(const analysis::RecallCurves& curves) {
  std::string text = "target_force,applied_force\n";
  RowText row(text, Delimited::kCsv);
  for (std::size_t i = 0; i < curves.target.force.size(); ++i) {
    row.add(curves.target.force[i]).add(curves.applied.force[i]).end();
  }
  return text;
}

/// The curves of one session. @returns its rows of conditions.csv.
std::string write_session(const NewFolder& out, const ExportSession& session, std::size_t place,
                          const analysis::ScoreParameters& parameters, Counter& counter,
                          std::size_t& trials) {
  const record::SessionReader reader(session.file);
  const auto passes = reader.passes();
  const auto recalls = analysis::session_recalls(reader, parameters, 1);
  std::string table;
  RowText row(table, Delimited::kCsv);
  for (const auto& [score, pass, spectrum] : recalls.scored) {
    const auto run = analysis::run_samples(reader, passes.at(pass));
    const auto name = fmt::format("{:03}/trial-{:03}.csv", place + 1, score.trial);
    const auto places = analysis::path_places(reader, score.block, parameters);
    const auto curves = analysis::recall_curves(*run, session.info.rate, places.get());
    out.write(name, curves_text(*curves));
    row.add(score.subject).add(score.trial).add(score.condition).add(score.block);
    row.add(score.repetition).add(session.info.simulated ? "true" : "false");
    row.add(curves->target.rate).add(name).end();
    ++trials;
    counter.check();
  }
  counter.add(session.samples);
  return table;
}

}  // namespace

CurvesSummary export_curves(std::span<const fs::path> files, const fs::path& folder,
                            const analysis::ScoreParameters& parameters, int jobs,
                            const Watch& watch) {
  const std::vector<ExportSession> sessions = sessions_to_export(files);
  refuse_second_sessions(sessions);
  NewFolder out(folder);
  std::vector<std::string> tables(sessions.size());
  std::vector<std::size_t> trials(sessions.size(), 0);
  share_out(
      sessions.size(), jobs,
      [&](std::size_t i, Counter& counter) {
        tables[i] = write_session(out, sessions[i], i, parameters, counter, trials[i]);
      },
      watch);
  std::string table = "subject,trial,condition,block,repetition,simulated,rate,file\n";
  CurvesSummary summary{sessions.size()};
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    table += tables[i];
    summary.trials += trials[i];
  }
  out.write("conditions.csv", table);
  out.publish();
  return summary;
}

}  // namespace haptrial::exchange
