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
# Every arrangement of the ranks: the shares as far out as the first.
shares <- function(case, statistic, sums, middle) {
  first <- sums[1]
  far <- abs(sums - middle) >= abs(first - middle) - 1e-9
  answer(paste(case, "two.sided"), statistic = statistic, p = mean(far))
  answer(paste(case, "less"), statistic = statistic, p = mean(sums <= first + 1e-9))
  answer(paste(case, "greater"), statistic = statistic, p = mean(sums >= first - 1e-9))
}
procedure("Wilcoxon signed-rank: exact with ties", "expand.grid of all signs")
signed <- function(case, d) {
  d <- d[d != 0]
  r <- rank(abs(d))
  signs <- as.matrix(expand.grid(rep(list(0:1), length(d))))
  v <- sum(r[d > 0])
  sums <- signs %*% r
  shares(case, v, sums[order(sums != v)], sum(r) / 2)
}
signed("tied pairs", tied_pairs$first - tied_pairs$second)
procedure("Wilcoxon signed-rank: approximate", "wilcox.test(a, b, paired = TRUE)")
tests("long pairs", long$first, long$second, paired = TRUE)

procedure("Mann-Whitney: exact", "wilcox.test(a, b)")
tests("a and d", unequal$a, unequal$d)
tests("c and b", unequal$c, unequal$b)
tests("one and one", 1, 2)
tests("49 and 49", 3 * (1:49), 2 * (1:49) + 0.5)
procedure("Mann-Whitney: exact with ties", "combn of all choices")
chosen <- function(case, a, b) {
  r <- rank(c(a, b))
  first <- sum(r[seq_along(a)])
  sums <- combn(length(r), length(a), function(i) sum(r[i]))  # the first choice is a itself
  shares(case, first - length(a) * (length(a) + 1) / 2, sums, length(a) * mean(r))
}
chosen("ties", ties$a, ties$c)
procedure("Mann-Whitney: approximate", "wilcox.test(a, b)")
tests("study", by_condition$visual, by_condition$haptic)

procedure("Kruskal-Wallis: approximate", "kruskal.test(groups)")
kruskal <- function(case, groups) {
  test <- kruskal.test(groups)
  answer(case, chi = test$statistic, df = test$parameter, p = test$p.value)
}
kruskal("unequal", unequal)
kruskal("ties", ties)
kruskal("study", by_condition)

procedure("Kruskal-Wallis: exact", "kruskal.test of every arrangement")
rank_sum <- function(r, group) sum(tapply(r, group, sum)^2 / tabulate(group))
local({
  group <- rep(1:3, c(4, 4, 3))
  r <- rank(c(1, 2, 2, 5, 3, 4, 4, 7, 5, 6, 8))
  found <- rank_sum(r, group)
  all <- unlist(combn(11, 4, function(first) {
    rest <- setdiff(1:11, first)
    combn(7, 4, function(i) rank_sum(r[c(first, rest[i], rest[-i])], group))
  }, simplify = FALSE))
  test <- kruskal.test(r, group)
  answer("few", chi = test$statistic, df = test$parameter, p = mean(all >= found - 1e-9))
})

friedman <- function(case, table, p) {
  test <- friedman.test(table)
  answer(case, chi = test$statistic, df = test$parameter, p = p(table, test))
}
means <- function(data, value) tapply(data[[value]], data[c("subject", "condition")], mean)
procedure("Friedman: exact", "friedman.test and its convolution over participants")
# Probabilities of doubled rank sums, an axis for each condition but the last, which follows.
convolved <- function(table, test) {
  k <- ncol(table)
  ranks <- t(apply(table, 1, rank))
  size <- 2 * k * nrow(table) + 1
  p <- array(0, rep(size, k - 1))
  p[1] <- 1
  orders <- function(v) {
    if (length(v) == 1) return(matrix(v))
    do.call(rbind, lapply(seq_along(v), function(i) cbind(v[i], orders(v[-i]))))
  }
  for (i in seq_len(nrow(ranks))) {
    all <- orders(2 * ranks[i, ])
    places <- which(p > 0, arr.ind = TRUE)
    next_p <- array(0, rep(size, k - 1))
    for (o in seq_len(nrow(all))) {
      to <- sweep(places, 2, all[o, -k], "+")
      next_p[to] <- next_p[to] + p[places] / nrow(all)
    }
    p <- next_p
  }
  places <- which(p > 0, arr.ind = TRUE)
  total <- k * (k + 1) * nrow(table)
  sums <- cbind(places - 1, total - rowSums(places - 1)) - total / k
  found <- sum((2 * colSums(ranks) - total / k)^2)
  sum(p[places][rowSums(sums^2) >= found - 1e-9])
}
friedman("study", means(study, "score"), convolved)
friedman("ratings", means(data_set("ratings"), "value"), convolved)
procedure("Friedman: approximate", "friedman.test(table)")
friedman("times", means(data_set("times"), "value"), function(table, test) test$p.value)
finish()
