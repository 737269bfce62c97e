#include "analysis/force_training/study/study_questions.h"

namespace haptrial::analysis {

StudyQuestions questions_of(const std::vector<std::string>& factors, const AnalysisPlan& plan,
                            int threads) {
  StudyQuestions questions{plan, factors};
  questions.resampling.count = 9999;
  questions.resampling.threads = threads;
  return questions;
}

}  // namespace haptrial::analysis
