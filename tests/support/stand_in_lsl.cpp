// A stand-in for liblsl: the same C functions, which keep what was pushed. For a test in another
// process, STAND_IN_LSL_FILE names a file to which each outlet writes what it got when it closes;
// the layer's clock then goes as the real one does.
#include "tests/support/stand_in_lsl.h"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <memory>

using haptrial::test::LslRecord;
using haptrial::test::LslStream;

namespace {

LslRecord record;

struct Info;
struct Node {
  Info* info;
  std::string path;
};
struct Info {
  LslStream stream;
  std::vector<std::unique_ptr<Node>> nodes;
};

Node* child(Node* parent, const char* name) {
  const std::string path = parent->path.empty() ? name : parent->path + "/" + name;
  parent->info->nodes.push_back(std::make_unique<Node>(Node{parent->info, path}));
  return parent->info->nodes.back().get();
}

/// Outlets are numbers from 1.
LslStream& stream(void* outlet) {
  return record.streams.at(reinterpret_cast<std::size_t>(outlet) - 1);
}

/// A line for the stream, then one for each sample or text: its time, what it held, and when it was
/// pushed.
void tell(const LslStream& s) {
  const char* file = std::getenv("STAND_IN_LSL_FILE");
  if (file == nullptr) {
    return;
  }
  std::ofstream out(file, std::ios::app);
  out << std::setprecision(17) << "stream\t" << s.name << "\t" << s.type << "\t" << s.channels
      << "\t" << s.rate << "\n";
  const auto channels = static_cast<std::size_t>(s.channels);
  for (std::size_t i = 0; i < s.timestamps.size(); ++i) {
    out << s.timestamps[i];
    if (i < s.texts.size()) {
      out << "\t" << s.texts[i];
    }
    for (std::size_t k = i * channels; k < (i + 1) * channels && k < s.values.size(); ++k) {
      out << "\t" << s.values[k];
    }
    out << "\t" << s.pushed.at(i) << "\n";
  }
}

double layer_clock() {
  if (std::getenv("STAND_IN_LSL_FILE") == nullptr) {
    return record.clock;
  }
  constexpr double kAhead = 12345.0;  // of the machine's clock, so that the two are not mixed up
  return kAhead +
         std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

extern "C" {

LslRecord* stand_in_lsl() { return &record; }

void* lsl_create_streaminfo(const char* name, const char* type, std::int32_t channels, double rate,
                            std::int32_t format, const char* source_id) {
  ++record.infos;
  auto* info = new Info;
  info->stream = {name, type, source_id, channels, format, rate, {}, {}, {}, {}, {}, true};
  info->nodes.push_back(std::make_unique<Node>(Node{info, ""}));
  return info;
}
void* lsl_get_desc(void* info) { return static_cast<Info*>(info)->nodes.front().get(); }
void* lsl_append_child(void* node, const char* name) {
  return child(static_cast<Node*>(node), name);
}
void* lsl_append_child_value(void* node, const char* name, const char* value) {
  auto* parent = static_cast<Node*>(node);
  parent->info->stream.description.emplace_back(child(parent, name)->path, value);
  return node;
}
void* lsl_create_outlet(void* info, std::int32_t, std::int32_t) {
  if (record.refuse_outlets) {
    return nullptr;
  }
  record.streams.push_back(static_cast<Info*>(info)->stream);
  return reinterpret_cast<void*>(record.streams.size());
}
std::int32_t lsl_push_chunk_dtn(void* outlet, const double* values, unsigned long count,
                                const double* timestamps) {
  LslStream& s = stream(outlet);
  if (record.push_result != 0) {
    return record.push_result;
  }
  if (count % static_cast<unsigned long>(s.channels) != 0) {
    return -3;
  }
  s.values.insert(s.values.end(), values, values + count);
  s.timestamps.insert(s.timestamps.end(), timestamps,
                      timestamps + count / static_cast<unsigned long>(s.channels));
  s.pushed.resize(s.timestamps.size(), layer_clock());
  return 0;
}
std::int32_t lsl_push_sample_strt(void* outlet, const char** text, double timestamp) {
  if (record.push_result == 0) {
    stream(outlet).texts.emplace_back(*text);
    stream(outlet).timestamps.push_back(timestamp);
    stream(outlet).pushed.push_back(layer_clock());
  }
  return record.push_result;
}
double lsl_local_clock() { return layer_clock(); }
const char* lsl_last_error() { return "the stand-in was told to fail"; }
void lsl_destroy_outlet(void* outlet) {
  stream(outlet).open = false;
  tell(stream(outlet));
}
void lsl_destroy_streaminfo(void* info) {
  --record.infos;
  delete static_cast<Info*>(info);
}
}
