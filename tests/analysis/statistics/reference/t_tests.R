source("reference.R")

tests <- function(case, a, b, ...) {
  for (tail in c("two.sided", "less", "greater")) {
    answer(paste(case, tail), p = t.test(a, b, alternative = tail, ...)$p.value)
  }
  test <- t.test(a, b, ...)
  answer(case, t = test$statistic, df = test$parameter, low = test$conf.int[1],
         high = test$conf.int[2], error = test$stderr,
         difference = if (length(test$estimate) == 2) -diff(test$estimate) else test$estimate)
  wider <- t.test(a, b, conf.level = 0.99, ...)$conf.int
  answer(paste(case, "99 %"), low = wider[1], high = wider[2])
}

unequal <- split(data_set("unequal")$value, data_set("unequal")$group)
study <- split(data_set("study")$score, data_set("study")$condition)
pairs <- data_set("pairs")
long <- data_set("long_pairs")

procedure("Student's t", "t.test(a, b, var.equal = TRUE)")
tests("a and d", unequal$a, unequal$d, var.equal = TRUE)
tests("study", study$visual, study$haptic, var.equal = TRUE)
procedure("Welch's t", "t.test(a, b)")
tests("a and d", unequal$a, unequal$d)
tests("study", study$visual, study$haptic)
procedure("Paired t", "t.test(a, b, paired = TRUE)")
tests("pairs", pairs$first, pairs$second, paired = TRUE)
tests("long pairs", long$first, long$second, paired = TRUE)
finish()
