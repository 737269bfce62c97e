// A stand-in for liblsl: the same C functions, which keep what was pushed, and inlets of streams
// that a test offers. For a test in another process, STAND_IN_LSL_FILE names a file to which each
// outlet writes what it got when it closes; STAND_IN_LSL_STREAM names a stream that a sender offers
// from then on. The layer's clock then goes as the real one does.
#include "tests/support/stand_in_lsl.h"

#include <dlfcn.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <memory>
#include <random>
#include <thread>

using haptrial::test::LslNetwork;
using haptrial::test::LslOffer;
using haptrial::test::LslRecord;
using haptrial::test::LslStream;

namespace {

LslRecord record;
LslNetwork network;

struct Info;
struct Node {
  Info* info;
  std::string path;
  std::size_t index{0};  // among nodes of this path
};
struct Info {
  LslStream stream;
  std::vector<std::unique_ptr<Node>> nodes;
  std::shared_ptr<LslOffer> offer{};  // of a stream that was found
};
struct Inlet {
  std::shared_ptr<LslOffer> offer;
  bool processes{true};    // until it is told not to
  bool has_offset{false};  // which it then keeps
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

/// Whether an offer has each NAME='VALUE' of a predicate, between which " and " stands.
bool fits(const LslOffer& offer, std::string predicate) {
  const std::pair<const char*, const std::string*> all[]{
      {"name", &offer.name}, {"type", &offer.type}, {"source_id", &offer.source_id}};
  predicate += " and ";
  for (std::size_t end = 0; (end = predicate.find(" and ")) != std::string::npos;) {
    bool holds = false;
    for (const auto& [property, value] : all) {
      holds = holds || predicate.substr(0, end) == std::string(property) + "='" + *value + "'";
    }
    if (!holds) {
      return false;
    }
    predicate.erase(0, end + 5);
  }
  return true;
}

void* info_of(const std::shared_ptr<LslOffer>& offer) {
  auto* info = new Info;
  info->offer = offer;
  info->nodes.push_back(std::make_unique<Node>(Node{info, ""}));
  return info;
}

/// Waits for a sample. @param take  of it, under the mutex @returns its stamp; 0: none came
template <class Take>
double pulled(void* inlet, double timeout, std::int32_t* error, Take take) {
  const auto* from = static_cast<Inlet*>(inlet);
  LslOffer& offer = *from->offer;
  std::unique_lock lock(network.mutex);
  network.came.wait_for(lock, std::chrono::duration<double>(timeout),
                        [&] { return offer.gone || !offer.sent.empty(); });
  *error = 0;
  if (offer.sent.empty()) {
    *error = offer.gone ? -2 : 0;
    return 0.0;
  }
  const LslOffer::Sent sample = offer.sent.front();
  offer.sent.pop_front();
  take(sample);
  return sample.stamp + (from->processes ? offer.offset : 0.0);
}

double machine_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double layer_clock() {
  if (network.has_clock) {
    return network.clock;
  }
  if (std::getenv("STAND_IN_LSL_FILE") == nullptr &&
      std::getenv("STAND_IN_LSL_STREAM") == nullptr) {
    return record.clock;
  }
  constexpr double kAhead = 12345.0;  // of the machine's clock, so that the two are not mixed up
  return kAhead + machine_clock();
}

/// The clock of a sender of another process: its seconds are 100 millionths longer.
double sender_clock(double machine) { return 77777.0 + machine / (1.0 + 100e-6); }

/// Offers a stream of 250 samples a second, each the machine's time at which it was measured. Some
/// come together, up to 0.1 s late. The layer measures the sender's clock every 5 s, within 0.2 ms.
void send_for_ever(const std::shared_ptr<LslOffer>& offer) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  double measured = machine_clock();
  double next_offset = measured;
  while (true) {
    const bool together = uniform(random) < 5e-3;
    std::this_thread::sleep_for(std::chrono::duration<double>(together ? 0.1 : 0.004));
    const double now = machine_clock();
    {
      const std::lock_guard lock(network.mutex);
      if (now >= next_offset) {
        next_offset = now + 5.0;
        offer->measured_at = sender_clock(now);
        offer->uncertainty = 2e-4;
        offer->offset = layer_clock() - offer->measured_at + 2e-4 * (2.0 * uniform(random) - 1.0);
      }
      for (; measured < now; measured += 0.004) {
        offer->sent.push_back({sender_clock(measured), {measured}, {}});
      }
    }
    network.came.notify_all();
  }
}

/// Begins the stream that the environment asks for, once.
void offer_stream() {
  static const bool begun = [] {
    const char* name = std::getenv("STAND_IN_LSL_STREAM");
    if (name == nullptr) {
      return false;
    }
    const auto offer = std::make_shared<LslOffer>();
    offer->name = name;
    offer->host = "stand-in";
    offer->rate = 250.0;
    offer->labels = {{"measured", "s"}};
    {
      const std::lock_guard lock(network.mutex);
      network.offers.push_back(offer);
    }
    Dl_info here{};  // the thread needs this library to the end of the process
    dladdr(reinterpret_cast<void*>(&offer_stream), &here);
    dlopen(here.dli_fname, RTLD_NOW | RTLD_NODELETE);
    std::thread(send_for_ever, offer).detach();
    return true;
  }();
  static_cast<void>(begun);
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
LslNetwork* stand_in_lsl_network() { return &network; }

std::int32_t lsl_resolve_bypred(void** found, std::uint32_t room, const char* predicate,
                                std::int32_t minimum, double timeout) {
  offer_stream();
  const std::lock_guard lock(network.mutex);
  std::int32_t count = 0;
  for (const auto& offer : network.offers) {
    if (!offer->gone && count < static_cast<std::int32_t>(room) && fits(*offer, predicate)) {
      ++record.infos;
      found[count++] = info_of(offer);
    }
  }
  network.looked_for += count < minimum ? timeout : 0.0;
  return count;
}
void* lsl_create_inlet(void* info, std::int32_t, std::int32_t, std::int32_t) {
  const std::lock_guard lock(network.mutex);
  const auto& offer = static_cast<Info*>(info)->offer;
  ++offer->inlets;
  return new Inlet{offer};
}
void lsl_destroy_inlet(void* inlet) {
  const std::lock_guard lock(network.mutex);
  --static_cast<Inlet*>(inlet)->offer->inlets;
  delete static_cast<Inlet*>(inlet);
}
void* lsl_get_fullinfo(void* inlet, double, std::int32_t* error) {
  const std::lock_guard lock(network.mutex);
  *error = 0;
  ++record.infos;
  return info_of(static_cast<Inlet*>(inlet)->offer);
}
void lsl_open_stream(void*, double, std::int32_t* error) { *error = 0; }
std::int32_t lsl_set_postprocessing(void* inlet, std::uint32_t flags) {
  static_cast<Inlet*>(inlet)->processes = flags != 0;
  return 0;
}
double lsl_time_correction_ex(void* inlet, double* remote, double* uncertainty, double timeout,
                              std::int32_t* error) {
  std::unique_lock lock(network.mutex);
  auto* const to = static_cast<Inlet*>(inlet);
  const LslOffer& offer = *to->offer;
  if (std::getenv("STAND_IN_LSL_STREAM") != nullptr) {
    network.came.wait_for(lock, std::chrono::duration<double>(timeout),
                          [&] { return offer.measured_at != 0.0; });
  }
  to->has_offset = to->has_offset || (offer.measured_at != 0.0 && !offer.silent);
  *error = to->has_offset ? 0 : -1;
  *remote = offer.measured_at;
  *uncertainty = offer.uncertainty;
  return offer.offset;
}
double lsl_pull_sample_d(void* inlet, double* values, std::int32_t room, double timeout,
                         std::int32_t* error) {
  return pulled(inlet, timeout, error, [&](const LslOffer::Sent& sample) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(room) && i < sample.values.size(); ++i) {
      values[i] = sample.values[i];
    }
  });
}
double lsl_pull_sample_str(void* inlet, char** texts, std::int32_t room, double timeout,
                           std::int32_t* error) {
  return pulled(inlet, timeout, error, [&](const LslOffer::Sent& sample) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(room); ++i) {
      texts[i] = strdup(i < sample.texts.size() ? sample.texts[i].c_str() : "");
    }
  });
}
void lsl_destroy_string(char* text) { std::free(text); }
std::int32_t lsl_get_channel_count(void* info) { return static_cast<Info*>(info)->offer->channels; }
std::int32_t lsl_get_channel_format(void* info) { return static_cast<Info*>(info)->offer->format; }
double lsl_get_nominal_srate(void* info) { return static_cast<Info*>(info)->offer->rate; }
const char* lsl_get_name(void* info) { return static_cast<Info*>(info)->offer->name.c_str(); }
const char* lsl_get_hostname(void* info) { return static_cast<Info*>(info)->offer->host.c_str(); }
void* lsl_child(void* node, const char* name) { return child(static_cast<Node*>(node), name); }
void* lsl_next_sibling_n(void* node, const char*) {
  auto* next = static_cast<Node*>(node);
  ++next->index;
  return next;
}
const char* lsl_child_value_n(void* node, const char* name) {
  const auto* one = static_cast<Node*>(node);
  const auto& label = one->info->offer->labels.at(one->index);
  return (std::strcmp(name, "label") == 0 ? label.first : label.second).c_str();
}
std::int32_t lsl_empty(void* node) {
  const auto* one = static_cast<Node*>(node);
  return one->path == "channels/channel" && one->index < one->info->offer->labels.size() ? 0 : 1;
}
void lsl_destroy_streaminfo(void* info) {
  --record.infos;
  delete static_cast<Info*>(info);
}
}
