// A hundred sessions on the real clock's terms, killed at random instants.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <new>

#include "core/base/random.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/session_resume.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record::session_kill_test {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

constexpr int kKills = 100;
constexpr std::uint64_t kBatch = 20;     // ticks between two looks at the log
constexpr std::uint64_t kSecond = 1000;  // ticks
constexpr std::uint64_t kPass = 3000;    // ticks of a pass; then a pause of kPause
constexpr std::uint64_t kPause = 1000;
constexpr std::uint64_t kCycle = kPass + kPause;

/// State of the child, seen by the parent.
struct Shared {
  std::atomic<std::uint64_t> given{0};  // rows of append() calls that returned
  std::atomic<int> doing{0};
};
enum Doing { kStarting, kWriting, kFlushing, kSyncing, kPausing, kActivities };

std::vector<Sample> session_samples() {
  std::vector<Sample> samples = test::hand_motion(40 * kCycle, 8);
  for (Sample& sample : samples) {
    const std::uint64_t at = sample.sequence % kCycle;
    sample.pass = at < kPass ? static_cast<std::int32_t>(sample.sequence / kCycle) : -1;
  }
  return samples;
}

/// The session from the tick on at which it stands, fifty times as fast as life.
[[noreturn]] void run_session(SessionWriter& writer, std::uint64_t from,
                              const std::vector<Sample>& samples, Shared& shared) {
  for (std::uint64_t at = from; at + kBatch <= samples.size();) {
    const std::uint64_t count = kBatch - at % kBatch;
    shared.doing = at % kCycle < kPass ? kWriting : kPausing;
    writer.append(std::span(samples).subspan(at, count));
    at += count;
    shared.given = at;
    if (at % kCycle == kPass) {
      shared.doing = kSyncing;
      writer.add_pass({1, "haptic", Phase::kTest, 1, 1, 7, at - kPass, at - 1, {}});
      writer.sync();
    }
    if (at % kSecond == 0) {
      shared.doing = kFlushing;
      writer.add_event({static_cast<std::int64_t>(at), "second", ""});
      writer.flush();
    }
    usleep(400);
  }
  for (;;) {
    pause();
  }
}

struct Killed {
  std::uint64_t given{0};
  int doing{0};
};

/// Starts the child, which creates or resumes the session, and kills it after `instant` [us].
Killed start_and_kill(const fs::path& file, const std::vector<Sample>& samples,
                      useconds_t instant) {
  void* memory =
      mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto* shared = new (memory) Shared;
  const pid_t pid = fork();
  if (pid == 0) {
    try {
      SessionInfo info = test::example_info();
      info.clock = "real";
      if (!SessionWriter::can_resume(file)) {
        SessionWriter writer(file, info);
        run_session(writer, 0, samples, *shared);
      }
      Resumed found;
      SessionWriter writer = SessionWriter::resume(file, found);
      shared->given = found.next_sequence;
      for (const OpenPass& open : found.open_passes) {
        // Here the pass goes on; a session would mark it aborted.
        if (open.last_sample % kCycle != kPass - 1) {
          continue;
        }
        writer.add_pass(
            {1, "haptic", Phase::kTest, 1, 1, 7, open.first_sample, open.last_sample, {}});
      }
      run_session(writer, found.next_sequence, samples, *shared);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "child: %s\n", error.what());
    }
    _exit(1);
  }
  usleep(instant);
  kill(pid, SIGKILL);
  int status = 0;
  waitpid(pid, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the session failed by itself";
  const Killed killed{shared->given, shared->doing};
  shared->~Shared();
  munmap(memory, sizeof(Shared));
  return killed;
}

void check_rows(const fs::path& partial, const std::vector<Sample>& samples, const Killed& killed) {
  const SessionReader reader(partial);
  const std::uint64_t rows = reader.sample_count();
  EXPECT_GE(rows + kSecond, killed.given) << "more than the last second is lost";
  const std::vector<Sample> back = reader.samples(0, rows);
  for (std::size_t i = 0; i < back.size(); ++i) {
    ASSERT_TRUE(test::same(back[i], test::on_file(samples[i]))) << "row " << i;
  }
  for (const PassRow& pass : reader.passes()) {
    EXPECT_LT(pass.last_sample, rows);
  }
}

TEST(SessionKillTest, HundredKillsLoseAtMostASecondAndTheSessionGoesOn) {
  const TemporaryFolder folder;
  const std::vector<Sample> samples = session_samples();
  RandomStream random(1, "kills");
  std::array<int, kActivities> doing{};
  std::uint64_t most_lost = 0;
  int without_file = 0;
  std::ofstream list(folder / "files.txt");
  // More of them, and later ones, on a machine so slow that these meet too little.
  const auto met = [&] { return std::min(doing[kWriting], doing[kPausing]) > 10; };
  for (int run = 0; run < kKills || !met(); ++run) {
    const fs::path file = folder / fmt::format("{:03}.h5", run);
    const fs::path partial = file.string() + ".partial";
    // Each file is killed twice: new, and resumed.
    for (int life = 0; life < 2; ++life) {
      const double latest = (life == 0 ? 2e5 : 5e4) * (1 + run / kKills);
      const auto instant = static_cast<useconds_t>(random.uniform(0.0, latest));
      const Killed killed = start_and_kill(file, samples, instant);
      ++doing[static_cast<std::size_t>(killed.doing)];
      if (!fs::exists(partial)) {
        EXPECT_EQ(killed.given, 0u);
        ++without_file;
        continue;
      }
      check_rows(partial, samples, killed);
      const std::uint64_t rows = SessionReader(partial).sample_count();
      if (killed.given > rows) {
        most_lost = std::max(most_lost, killed.given - rows);
      }
    }
    if (fs::exists(partial)) {
      list << partial.string() << '\n';
    }
  }
  list.close();
  std::printf(
      "%d kills: %d starting, %d writing, %d flushing, %d syncing, %d pausing; %d before "
      "there was a file; at most %.3f s lost\n",
      2 * kKills, doing[kStarting], doing[kWriting], doing[kFlushing], doing[kSyncing],
      doing[kPausing], without_file, 1e-3 * static_cast<double>(most_lost));

  // The files are opened as a user without our code opens them: all in one process.
  std::ofstream(folder / "open.py")
      << "import h5py,sys\n"
         "for name in open(sys.argv[1]).read().split():\n"
         "  with h5py.File(name,'r',swmr=True) as f:\n"
         "    s=f['samples']['sequence'][:]; assert (s==range(len(s))).all()\n"
         "    [f[d][:] for d in ('trials','events','stimuli','frames','timing','attributes')]\n"
         "    assert f.attrs['subject']=='P07'\n";
  EXPECT_EQ(
      std::system(fmt::format("/usr/bin/python3 {0}/open.py {0}/files.txt", folder.path().string())
                      .c_str()),
      0);

  // Every one goes on to its end, without a gap.
  for (int run = 0; run < kKills; ++run) {
    const fs::path file = folder / fmt::format("{:03}.h5", run);
    if (!SessionWriter::can_resume(file)) {
      continue;
    }
    Resumed found;
    SessionWriter writer = SessionWriter::resume(file, found);
    std::uint64_t end = found.next_sequence;
    for (OpenPass& open : found.open_passes) {
      writer.add_pass({1, "haptic", Phase::kTest, 1, 1, 7, open.first_sample, open.last_sample,
                       PassStatus::kAborted});
    }
    std::vector<Sample> rest(samples.begin() + static_cast<std::ptrdiff_t>(end),
                             samples.begin() + static_cast<std::ptrdiff_t>(end + 2500));
    for (Sample& sample : rest) {
      sample.pass = -1;
    }
    writer.append(rest);
    writer.set_timing({}, {2500, 0, 0});
    writer.close();
    const Integrity integrity = check_session(SessionReader(file));
    EXPECT_TRUE(integrity.ok) << file << ": " << integrity.problems.front();
    EXPECT_EQ(integrity.rows, end + 2500);
  }
}

}  // namespace
}  // namespace haptrial::record::session_kill_test
