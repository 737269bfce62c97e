// Alignment of 1000 x 1000 samples with its path: every kernel of this machine, one pair at a time
// and side by side, beside a plain textbook search in double precision; the other forms of the
// options; several cores; and the scores of a whole study.
//
//     bench_alignment [samples] [runs]

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "analysis/alignment/alignment.h"
#include "analysis/force_training/score/score.h"
#include "core/base/random.h"

namespace {

using namespace haptrial::analysis;

constexpr std::size_t kPairs = 64;

struct Curve {
  std::vector<double> force, slope;
};

Curve smooth_curve(haptrial::RandomStream& random, std::size_t samples) {
  Curve curve;
  const double phase = random.uniform(0.0, 6.0), pitch = random.uniform(6.0, 18.0);
  for (std::size_t i = 0; i < samples; ++i) {
    const double angle = phase + pitch * static_cast<double>(i) / static_cast<double>(samples);
    curve.force.push_back(5.0 + 4.0 * std::sin(angle) + 0.1 * random.normal());
    curve.slope.push_back(3.0 * std::cos(angle) + 0.1 * random.normal());
  }
  return curve;
}

/// The baseline: the matrix and one byte a cell for the way back, nothing clever.
class Textbook {
 public:
  void align(const CurveView& a, const CurveView& b, const AlignmentOptions& p, Alignment& result) {
    const std::size_t rows = a.force.size(), columns = b.force.size();
    steps_.resize(rows * columns);
    above_.assign(columns + 1, std::numeric_limits<double>::infinity());
    row_.resize(columns + 1);
    above_[0] = 0.0;
    for (std::size_t i = 0; i < rows; ++i) {
      row_[0] = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < columns; ++j) {
        double best = above_[j];
        char way = 'd';
        if (above_[j + 1] + p.penalty < best) {
          best = above_[j + 1] + p.penalty, way = 'u';
        }
        if (row_[j] + p.penalty < best) {
          best = row_[j] + p.penalty, way = 'l';
        }
        row_[j + 1] = best + p.force_weight * std::abs(a.force[i] - b.force[j]) +
                      p.slope_weight * std::abs(a.slope[i] - b.slope[j]);
        steps_[i * columns + j] = way;
      }
      std::swap(row_, above_);
    }
    result.cost = above_[columns];
    result.path.clear();
    for (std::size_t i = rows - 1, j = columns - 1;;) {
      result.path.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)});
      if (i == 0 && j == 0) {
        break;
      }
      const char way = steps_[i * columns + j];
      if (way != 'l') {
        --i;
      }
      if (way != 'u') {
        --j;
      }
    }
    std::reverse(result.path.begin(), result.path.end());
  }

 private:
  std::vector<double> above_, row_;
  std::vector<char> steps_;
};

/// Processor time of this thread: what another program takes in between does not count.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Work>
double seconds_of(int runs, Work work, double (*clock)() = thread_seconds) {
  work();
  std::vector<double> seconds;
  for (int run = 0; run < runs; ++run) {
    const double start = clock();
    work();
    seconds.push_back(clock() - start);
  }
  // Elapsed time counts what other programs take meanwhile: the best run has the least of it.
  if (clock == wall_seconds) {
    return *std::min_element(seconds.begin(), seconds.end());
  }
  std::nth_element(seconds.begin(), seconds.begin() + runs / 2, seconds.end());
  return seconds[static_cast<std::size_t>(runs) / 2];
}

/// Frequency of the processor from a chain of six dependent one-cycle operations, best of several.
double cycles_per_second() {
  constexpr long kRounds = 2'000'000;
  double best = std::numeric_limits<double>::infinity();
  std::uint64_t x = 88172645463325252u;
  for (int run = 0; run < 20; ++run) {
    const double start = thread_seconds();
    for (long k = 0; k < kRounds; ++k) {
      x ^= x << 13;
      x ^= x >> 7;
      x ^= x << 17;
    }
    best = std::min(best, thread_seconds() - start);
  }
  return x == 0 ? 0.0 : 6.0 * kRounds / best;
}

void print_row(const std::string& name, double seconds, std::size_t pairs, std::size_t samples,
               double baseline_rate, double clock) {
  const double rate = static_cast<double>(pairs) / seconds;
  const double cells = static_cast<double>(samples * samples);
  std::printf("%-28s %10.0f %10.4f %12.2f %10.1f\n", name.c_str(), rate, 1e9 / (rate * cells),
              rate * cells / clock, rate / baseline_rate);
}

struct Form {
  const char* name;
  AlignmentOptions options;
};

std::vector<Form> forms(std::size_t samples) {
  const auto with = [](auto change) {
    AlignmentOptions options;
    change(options);
    return options;
  };
  using Options = AlignmentOptions;
  return {
      {"symmetric2", with([](Options& o) { o.pattern = StepPattern::kSymmetric2; })},
      {"asymmetric", with([](Options& o) { o.pattern = StepPattern::kAsymmetric; })},
      {"symmetricP1", with([](Options& o) { o.pattern = StepPattern::kSymmetricP1; })},
      {"published, open ends", with([](Options& o) { o.open_begin = o.open_end = true; })},
      {"published, window of all", with([=](Options& o) { o.window = samples; })},
      {"published, window of 10 %", with([=](Options& o) { o.window = samples / 10; })},
      {"published, p = 1.5", with([](Options& o) { o.power = 1.5; })},
      {"published, p = 1.7", with([](Options& o) { o.power = 1.7; })},
  };
}

void measure_forms(std::span<const AlignmentPair> pairs, std::size_t samples, double plain_rate,
                   double clock, int runs) {
  constexpr std::size_t kFew = 16;
  std::vector<Alignment> results(kFew);
  Aligner aligner;
  for (const Form& form : forms(samples)) {
    const double seconds = seconds_of(std::min(runs, 5), [&] {
      for (std::size_t k = 0; k < kFew; ++k) {
        aligner.align(pairs[k].target, pairs[k].applied, form.options, results[k]);
      }
    });
    print_row(form.name, seconds, kFew, samples, plain_rate, clock);
  }
}

/// 12 participants of 72 trials: recalls of 15 s at 1 kHz.
void measure_study(int cores) {
  constexpr std::size_t kRecalls = 864, kSamples = 15000;
  haptrial::RandomStream random(2, "study");
  std::vector<ForceCurve> curves(2 * kRecalls);
  for (ForceCurve& curve : curves) {
    curve = {1000.0, smooth_curve(random, kSamples).force};
  }
  std::vector<RecallPair> recalls;
  for (std::size_t k = 0; k < kRecalls; ++k) {
    recalls.push_back({&curves[2 * k], &curves[2 * k + 1]});
  }
  for (int jobs = 1; jobs <= cores; jobs *= 2) {
    const double seconds = seconds_of(
        3, [&] { score_recalls(recalls, ScoreParameters{}, jobs); }, wall_seconds);
    std::printf("%zu recalls of %zu samples scored in %.3f s by %d thread%s\n", kRecalls, kSamples,
                seconds, jobs, jobs == 1 ? "" : "s");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const long samples_asked = argc > 1 ? std::atol(argv[1]) : 1000;
  const int runs = argc > 2 ? std::atoi(argv[2]) : 9;
  if (samples_asked < 1 || samples_asked > 10000 || runs < 1) {
    std::fprintf(stderr, "usage: bench_alignment [samples 1..10000] [runs 1..]\n");
    return 2;
  }
  const auto samples = static_cast<std::size_t>(samples_asked);
  haptrial::RandomStream random(1, "benchmark");
  std::vector<Curve> curves;
  for (std::size_t k = 0; k < 2 * kPairs; ++k) {
    curves.push_back(smooth_curve(random, samples));
  }
  std::vector<AlignmentPair> pairs;
  for (std::size_t k = 0; k < kPairs; ++k) {
    const Curve &target = curves[2 * k], &applied = curves[2 * k + 1];
    pairs.push_back({{target.force, target.slope}, {applied.force, applied.slope}});
  }
  const AlignmentOptions parameters;
  std::vector<Alignment> results(kPairs), reference(kPairs);

  const double clock = cycles_per_second();
  constexpr std::size_t kTextbookPairs = 8;
  Textbook textbook;
  const double plain = seconds_of(runs, [&] {
    for (std::size_t k = 0; k < kTextbookPairs; ++k) {
      textbook.align(pairs[k].target, pairs[k].applied, parameters, reference[k]);
    }
  });
  const double plain_rate = kTextbookPairs / plain;
  std::printf("%zu x %zu samples with path, median of %d runs, a core at %.2f GHz\n", samples,
              samples, runs, clock / 1e9);
  std::printf("%-28s %10s %10s %12s %10s\n", "", "pairs/s", "ns/cell", "cells/cycle", "x textbook");
  print_row("textbook, fp64, scalar", plain, kTextbookPairs, samples, plain_rate, clock);
  for (const InstructionSet set : available_instruction_sets()) {
    Aligner aligner(set);
    const std::string name(name_of(set));
    const double single = seconds_of(runs, [&] {
      for (std::size_t k = 0; k < kPairs; ++k) {
        aligner.align(pairs[k].target, pairs[k].applied, parameters, results[k]);
      }
    });
    print_row(name + ", single pair", single, kPairs, samples, plain_rate, clock);
    const double batch = seconds_of(runs, [&] { aligner.align_batch(pairs, parameters, results); });
    print_row(name + ", batch of " + std::to_string(aligner.lanes()) + " lanes", batch, kPairs,
              samples, plain_rate, clock);
    for (std::size_t k = 0; k < kTextbookPairs; ++k) {
      if (std::abs(results[k].cost - reference[k].cost) > 1e-4 * reference[k].cost) {
        std::fprintf(stderr, "pair %zu costs %.9g, the textbook says %.9g\n", k, results[k].cost,
                     reference[k].cost);
        return 1;
      }
    }
  }
  measure_forms(pairs, samples, plain_rate, clock, runs);
  const int cores = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 8);
  for (int jobs = 1; jobs <= cores; jobs *= 2) {
    const double seconds = seconds_of(
        runs, [&] { align_batch(pairs, parameters, jobs); }, wall_seconds);
    print_row("batch, elapsed, threads: " + std::to_string(jobs), seconds, kPairs, samples,
              plain_rate, clock);
  }
  measure_study(cores);
  return 0;
}
