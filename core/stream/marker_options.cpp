#include "core/stream/marker_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/definition/schema.h"
#include "core/stream/serial_line.h"

namespace haptrial::markers {
namespace {

using record::MarkerOf;

constexpr int kMostCode = 255;

void read_send(Table& table, MarkerOptions& options) {
  options.send.clear();
  for (const std::string& word : table.texts("send")) {
    constexpr std::array kAll{MarkerOf::kTrial, MarkerOf::kInterval, MarkerOf::kStage,
                              MarkerOf::kResponse};
    const auto* found = std::find_if(kAll.begin(), kAll.end(),
                                     [&](MarkerOf what) { return word == record::name_of(what); });
    if (found == kAll.end()) {
      table.reject("send", fmt::format("\"{}\"", word), "stage, response, interval, trial");
    } else if (std::ranges::find(options.send, *found) == options.send.end()) {
      options.send.push_back(*found);
    }
  }
}

/// "stage press", or "trial" alone.
std::string full_name(const MarkerMeaning& meaning) {
  const std::string what = record::name_of(meaning.what);
  return meaning.name == what ? what : what + " " + meaning.name;
}

}  // namespace

const Schema<MarkerOptions>& marker_schema() {
  using O = MarkerOptions;
  static const auto schema =
      Schema<O>()
          .text("serial", &O::serial,
                "Serial line that receives each code as a byte, such as \"/dev/ttyUSB0\"")
          .otherwise("none")
          .text("neon", &O::neon,
                "Address of a Pupil Labs Neon's phone, HOST or HOST:PORT, whose recording gets "
                "each onset as an event")
          .otherwise("none")
          .integer("baud", &O::baud, 1, 10'000'000, "Speed of the serial line, in bits per second")
          .number("pulse", &O::pulse, {0.0, 1.0}, "s",
                  "Time for which a code stands on the serial line before a zero follows; 0: it "
                  "stays")
          .integer("trial", &O::trial, 1, kMostCode, "Code of the beginning of a trial")
          .integer("interval", &O::interval, 1, kMostCode,
                   "Code of the first interval; the codes of the others count on from it")
          .integer("stage", &O::stage, 1, kMostCode,
                   "Code of the first stage; the codes of the others count on from it")
          .integer("response", &O::response, 1, kMostCode,
                   "Code of the first answer; the codes of the others count on from it")
          .custom("send",
                  "Kinds of marker that go to the serial line; codes of one tick go in this order",
                  [](Table& table, const std::string&, O& o) { read_send(table, o); })
          .otherwise("stage, response, interval, trial")
          .check([](Table& table, O& o) {
            o.used = true;
            if (!SerialLine::has_rate(o.baud)) {
              table.reject("baud", fmt::format("{}", o.baud),
                           "9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600");
            }
          });
  return schema;
}

void check_meanings(Table& root, const char* key, const std::vector<MarkerMeaning>& meanings) {
  for (std::size_t i = 0; i < meanings.size(); ++i) {
    const MarkerMeaning& one = meanings[i];
    if (one.code < 1 || one.code > kMostCode) {
      root.reject(key, fmt::format("give {} the code {}; allowed: 1 to {}. Choose another first "
                                   "code of its kind",
                                   full_name(one), one.code, kMostCode));
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (meanings[k].code == one.code) {
        root.reject(key, fmt::format("give the code {} two meanings, {} and {}; give one of them "
                                     "another",
                                     one.code, full_name(meanings[k]), full_name(one)));
      }
    }
  }
}

std::string words_of(const std::vector<MarkerMeaning>& meanings) {
  std::string words;
  for (const MarkerMeaning& meaning : meanings) {
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", full_name(meaning), meaning.code);
  }
  return words;
}

const MarkerMeaning* meaning_of(const std::vector<MarkerMeaning>& meanings, const Onset& onset) {
  const auto found = std::find_if(meanings.begin(), meanings.end(), [&](const MarkerMeaning& each) {
    return each.what == onset.what && each.index == onset.index;
  });
  return found == meanings.end() ? nullptr : &*found;
}

}  // namespace haptrial::markers
