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
# Terms of repeated-measures and mixed designs; G*Power 3's f, correlation and epsilon.
repeated_power <- function(term, k, m, n, f, rho, eps) {
  lambda <- k * n * m * f^2 / if (term == "between") 1 + (m - 1) * rho else (1 - rho) / eps
  df1 <- switch(term, within = eps * (m - 1), between = k - 1, interaction = eps * (k - 1) * (m - 1))
  df2 <- (k * n - k) * if (term == "between") 1 else eps * (m - 1)
  q <- qf(0.05, df1, df2, lower.tail = FALSE)
  j <- 0:3000
  p <- sum(dpois(j, lambda / 2) *
             pbeta(q * df1 / (q * df1 + df2), df1 / 2 + j, df2 / 2, lower.tail = FALSE))
  stopifnot(abs(p - pf(q, df1, df2, lambda, lower.tail = FALSE)) < 1e-8)
  p
}
procedure("Power of repeated measures and mixed designs", "sum(dpois * pbeta); pf(ncp = )")
for (term in c("within", "interaction", "between")) for (m in c(2, 4)) for (eps in c(1, 0.6)) {
  if (m == 2 && eps < 1) next
  for (n in c(6, 25)) for (rho in c(0, 0.5, 0.8)) {
    answer(paste(term, m, eps, n, rho), power = repeated_power(term, 2, m, n, 0.25, rho, eps))
  }
  answer(paste(term, m, eps),
         n = solve(function(n) repeated_power(term, 2, m, n, 0.25, 0.5, eps) - 0.8, c(2, 999)))
}
finish()
