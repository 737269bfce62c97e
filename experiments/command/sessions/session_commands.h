#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/record/rows/session_types.h"

namespace haptrial::experiments {

// Each subcommand prints to standard output and returns an exit status. Bad input and failures come
// as InputError and RunError.

struct DryRunOptions {
  std::string definition;
  std::optional<int> subjects;  // default: as the definition says
  std::string seed{"1"};
  std::optional<int> jobs;  // default: one per processor
  std::string out;          // default: a new folder out/NAME-001
  std::string parts;        // in its place, a folder that is gone on with
  int frames{0};
  std::optional<int> trials;       // default: all
  std::optional<int> session;      // of each subject; default: all, in their order
  std::string tutor;               // `FILE`, `FILE:TRIAL` or `FILE:TRIAL@SECONDS`; empty: none
  bool taught{false};              // each subject, by a second one over a simulated network
  std::string language;            // of what participants read; default: the definition's own
  std::vector<std::string> set{};  // KEY=VALUE of the definition
};
int dry_run(const DryRunOptions& options);

struct RunOptions {
  std::string definition;
  std::string subject;                          // empty: the next one of the roster
  std::vector<std::string> devices{"virtual"};  // in the order in which the protocol has them
  std::string library;                          // of the device's vendor, in place of the search
  std::string seed{"1"};
  std::optional<int> participant;  // default: the number at the end of the subject's identifier
  std::optional<int> session;      // default: the first that the subject has left
  std::string out;                 // default: out/sessions, out/teaching with --teach
  std::optional<int> trials;       // default: all
  std::string tutor;               // `FILE`, `FILE:TRIAL` or `FILE:TRIAL@SECONDS`; empty: none
  std::optional<int> teach;        // port at which the side that learns is awaited
  std::string learn_from;          // HOST:PORT of the side that teaches; empty: nobody
  std::string secret;              // file that both sides have
  bool console{false};
  std::vector<std::string> auxiliary_pages;  // of the protocol, beside the console
  bool keyboard{false};
  std::optional<std::string> address;  // of the console; default: the loopback's
  std::optional<int> port;             // of the console; default: any that is free
  bool remote{false};  // the console may listen on another address than the loopback's
  bool window{false};
  bool stream{false};
  bool stream_optional{false};
  bool resume{false};
  bool pilot{false};
  std::string language;  // of what the participant reads; default: the definition's own
  record::Participant person;
};
int run(const RunOptions& options);

/// Makes the file of a secret that two sides of a link share.
int make_secret(const std::string& file);

/// Options of the roster: past sessions of a study, and the next one.
struct RosterOptions {
  std::string definition;
  std::string folder;               // of session files
  std::optional<std::string> seed;  // of new participants; default: that of the sessions, or 1
  std::string json;                 // file for the same; empty: none
  std::string csv;                  // likewise, a row for each session
  std::string exclude;              // participant to be taken out before; empty: nobody
  std::string because;              // why
};
int roster(const RosterOptions& options);

struct ReplayOptions {
  std::string file;
  int trial{0};
  std::string phase;   // "training", "test"; empty: both
  std::string video;   // .mp4
  std::string frames;  // folder
  std::string sound;   // .wav, of a drilling
  int fps{30};
};
int replay(const ReplayOptions& options);

int info(const std::string& file);
/// @param out  new session file; empty: beside the damaged one
/// @returns 0 when something was recovered, else 1.
int recover(const std::string& file, const std::string& out);
int validate(const std::string& definition);

}  // namespace haptrial::experiments
