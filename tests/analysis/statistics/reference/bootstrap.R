# Resampled rows come from a generator that both sides have: x <- 16807 x mod (2^31 - 1).
source("reference.R")
library(boot)

draws <- function(n, count) {
  x <- 20061
  rows <- matrix(0, count, n)
  for (i in seq_len(count)) for (j in seq_len(n)) {
    x <- (16807 * x) %% 2147483647
    rows[i, j] <- 1 + x %% n
  }
  rows
}

limits <- function(case, data, statistic, replicates, influence, level, ...) {
  fit <- boot(data, statistic, R = nrow(replicates), ...)  # for its form; its replicates go
  fit$t <- replicates
  fit$R <- nrow(replicates)
  interval <- boot.ci(fit, level, "bca", L = influence)$bca
  answer(paste(case, level), estimate = fit$t0, low = interval[4], high = interval[5],
         bias = qnorm(mean(replicates < fit$t0)),
         acceleration = sum(influence^3) / (6 * sum(influence^2)^1.5))
}
influence <- function(data, statistic) {
  n <- length(data)
  left_out <- sapply(seq_len(n), function(i) statistic(data, seq_len(n)[-i]))
  (n - 1) * (mean(left_out) - left_out) / n
}

values <- data_set("pairs")$first
second <- data_set("pairs")$second
statistics <- list(mean = function(x, i) mean(x[i]), spread = function(x, i) log(var(x[i])),
                   ratio = function(x, i) mean(x[i]) / mean(second[i]))
rows <- draws(length(values), 1999)
procedure("BCa bootstrap of one sample", "boot.ci(type = 'bca') given the rows")
for (case in names(statistics)) for (level in c(0.9, 0.95)) {
  f <- statistics[[case]]
  limits(case, values, f, matrix(apply(rows, 1, function(i) f(values, i))), influence(values, f),
         level)
}

# Two samples: the influence of a row is divided by the size of its sample (Davison and Hinkley). Of
# logarithms, whose means do not tie: boot.ci would count ties as rounding has it, we as halves.
data <- subset(data_set("unequal"), group %in% c("b", "d"))
data$value <- log(data$value)
b <- data$value[data$group == "b"]
d <- data$value[data$group == "d"]
difference <- function(x, i) {
  drawn <- x[i, ]
  mean(drawn$value[drawn$group == "b"]) - mean(drawn$value[drawn$group == "d"])
}
rows <- cbind(draws(length(b), 1999), length(b) + draws(length(d), 1999))
procedure("BCa bootstrap of a difference", "boot.ci(type = 'bca') given the rows")
limits("b and d", data, difference, matrix(apply(rows, 1, function(i) difference(data, i))),
       c(influence(b, function(x, i) mean(x[i])), -influence(d, function(x, i) mean(x[i]))), 0.95,
       strata = droplevels(data$group))
finish()
