source("reference.R")

tests <- function(case, a, b, ...) {
  for (tail in c("two.sided", "less", "greater")) {
    test <- suppressWarnings(wilcox.test(a, b, alternative = tail, ...))
    answer(paste(case, tail), statistic = test$statistic, p = test$p.value)
  }
}
unequal <- split(data_set("unequal")$value, data_set("unequal")$group)
ties <- split(data_set("ties")$value, data_set("ties")$group)
study <- data_set("study")
by_condition <- split(study$score, study$condition)
pairs <- data_set("pairs")
tied_pairs <- data_set("tied_pairs")
long <- data_set("long_pairs")

procedure("Wilcoxon signed-rank: exact", "wilcox.test(a, b, paired = TRUE)")
tests("pairs", pairs$first, pairs$second, paired = TRUE)
tests("first five", pairs$first[1:5], pairs$second[1:5], paired = TRUE)
tests("one", pairs$first[1], pairs$second[1], paired = TRUE)
tests("49", 1:49, (1:49) + 1.5078125 - 0.03125 * (1:49), paired = TRUE)
procedure("Wilcoxon signed-rank: approximate", "wilcox.test(a, b, paired = TRUE)")
tests("tied pairs", tied_pairs$first, tied_pairs$second, paired = TRUE)
tests("long pairs", long$first, long$second, paired = TRUE)

procedure("Mann-Whitney: exact", "wilcox.test(a, b)")
tests("a and d", unequal$a, unequal$d)
tests("c and b", unequal$c, unequal$b)
tests("one and one", 1, 2)
tests("49 and 49", 3 * (1:49), 2 * (1:49) + 0.5)
procedure("Mann-Whitney: approximate", "wilcox.test(a, b)")
tests("ties", ties$a, ties$c)
tests("study", by_condition$visual, by_condition$haptic)

procedure("Kruskal-Wallis", "kruskal.test(groups)")
kruskal <- function(case, groups) {
  test <- kruskal.test(groups)
  answer(case, chi = test$statistic, df = test$parameter, p = test$p.value)
}
kruskal("unequal", unequal)
kruskal("ties", ties)
kruskal("study", by_condition)

procedure("Friedman", "friedman.test(table)")
friedman <- function(case, data, value) {
  test <- friedman.test(tapply(data[[value]], data[c("subject", "condition")], mean))
  answer(case, chi = test$statistic, df = test$parameter, p = test$p.value)
}
friedman("study", study, "score")
friedman("times", data_set("times"), "value")
friedman("ratings", data_set("ratings"), "value")
finish()
