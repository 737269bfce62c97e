#include "tests/experiments/timed_session.h"

#include <chrono>
#include <thread>

#include "core/record/hdf5/session_writer.h"
#include "protocols/force_training/trajectory_pass.h"
#include "protocols/force_training/virtual_rig.h"
#include "protocols/interface/session_task.h"
#include "tests/experiments/shipped.h"

namespace haptrial::test {
namespace {

/// Leaves the loop after a number of ticks.
class Counted final : public realtime::ServoTask {
 public:
  Counted(realtime::ServoTask& task, std::uint64_t ticks) : task_(task), ticks_(ticks) {}
  bool tick(const realtime::Tick& tick) noexcept override {
    return task_.tick(tick) && tick.index + 1 < ticks_;
  }

 private:
  realtime::ServoTask& task_;
  std::uint64_t ticks_;
};

}  // namespace

TimedSession run_timed_session(std::uint64_t ticks, const std::filesystem::path& file) {
  using Clock = std::chrono::steady_clock;
  const auto definition = protocols::load_force_definition(shipped_definition());
  protocols::VirtualRig rig(definition, 1);
  protocols::SessionTask::Log log;
  protocols::SessionTask task(rig.device(), definition.envelope, log, {rig.subject()},
                              protocols::SessionTask::Leave::kNever);
  realtime::ServoLoop loop(realtime::ClockKind::kReal, definition.rate);
  record::SessionWriter writer(file, {});
  const auto stimulus = stimulus::make_stimulus(definition.trajectory, definition.force_pattern, 1);
  const auto append = [&](std::span<const record::Sample> rows) { writer.append(rows); };

  Counted counted(task, ticks);
  std::atomic<bool> over{false};
  const auto start = Clock::now();
  std::thread servo([&] {
    loop.run(counted);
    over = true;
  });
  std::unique_ptr<protocols::TrajectoryPass> pass;
  while (!over) {
    if (task.idle()) {
      pass = std::make_unique<protocols::TrajectoryPass>(protocols::kRecallTest, stimulus,
                                                         definition.guidance, 1);
      task.start(*pass, 0);
    }
    log.drain(append);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  servo.join();
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  log.flush(append);
  writer.close();
  return {loop.ticks(), loop.overruns(), log.dropped(),
          seconds,      loop.timing(),   loop.real_time_status()};
}

}  // namespace haptrial::test
