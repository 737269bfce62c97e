# strict = TRUE counts both tails of a two-sided test.
source("reference.R")

procedure("Power of t-tests", "power.t.test(strict = TRUE)")
for (type in c("two.sample", "one.sample", "paired")) for (tails in c("two.sided", "one.sided")) {
  for (n in c(2, 5, 17, 60)) for (delta in c(0.1, 0.5, 1.3)) {
    answer(paste(type, tails, n, delta),
           power = power.t.test(n, delta, type = type, alternative = tails, strict = TRUE)$power)
  }
  case <- paste(type, tails)
  solve <- function(...) power.t.test(..., type = type, alternative = tails, strict = TRUE,
                                      tol = 1e-13)
  answer(case, n = solve(delta = 0.5, power = 0.8)$n, n_small = solve(delta = 0.05, power = 0.95)$n,
         delta = solve(n = 12, power = 0.8)$delta,
         n_strict = solve(delta = 0.7, power = 0.9, sig.level = 0.001)$n)
}
# pf is right to 1e-9 only, so the noncentral F is summed from its terms; power.anova.test must agree
# to that.
anova_power <- function(groups, n, f) {
  df <- groups * (n - 1)
  q <- qf(0.05, groups - 1, df, lower.tail = FALSE)
  j <- 0:3000
  p <- sum(dpois(j, groups * n * f^2 / 2) *
             pbeta(q * (groups - 1) / (q * (groups - 1) + df), (groups - 1) / 2 + j, df / 2,
                   lower.tail = FALSE))
  # between.var is that of the groups' means, with groups - 1 below
  theirs <- power.anova.test(groups, n, f^2 * groups / (groups - 1), 1)$power
  stopifnot(abs(p - theirs) < 1e-8)
  p
}
solve <- function(f, interval) uniroot(f, interval, tol = 1e-15, maxiter = 10000)$root
procedure("Power of one-way ANOVA", "sum(dpois * pbeta); power.anova.test")
for (groups in c(2, 3, 6)) {
  for (n in c(2, 8, 40)) for (f in c(0.1, 0.25, 0.8)) {
    answer(paste(groups, n, f), power = anova_power(groups, n, f))
  }
  answer(paste(groups), n = solve(function(n) anova_power(groups, n, 0.25) - 0.8, c(2, 999)),
         f = solve(function(f) anova_power(groups, 15, f) - 0.9, c(0.01, 3)))
}
finish()
