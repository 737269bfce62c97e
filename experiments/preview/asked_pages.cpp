#include "experiments/preview/asked_pages.h"

#include <istream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "core/base/exception_words.h"
#include "core/base/whole_file.h"
#include "experiments/preview/preview.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {
namespace {

nlohmann::json page_for(const std::string& line) {
  try {
    const auto asked = nlohmann::json::parse(line);
    const std::string out = asked.at("out");
    PreviewRequest request;
    request.trial = asked.at("trial");
    request.virtual_trial = asked.at("virtual");
    request.language = asked.value("headings", "");
    const Experiment experiment = load_experiment(asked.at("file").get<std::string>());
    write_whole(out, preview_of(experiment, request).html());
    return {{"page", out}};
  } catch (const std::exception& error) {  // the next line may be a good one
    return {{"failure", "haptrial: " + sentence_of(error)}};
  }
}

}  // namespace

void answer_page_requests(std::istream& in, std::ostream& out) {
  out << "{}" << std::endl;  // whoever reads waits for each line
  for (std::string line; std::getline(in, line);) {
    out << page_for(line).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)
        << std::endl;
  }
}

}  // namespace haptrial::experiments
