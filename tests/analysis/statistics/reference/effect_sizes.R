# The intervals come by uniroot to the last digits from pt and from the terms of the noncentral F,
# of which pf is right to 1e-9 only. The package effectsize, which searches to about four digits, is
# asked as well and must agree to those.
source("reference.R")
suppressMessages(library(effectsize))

root <- function(f, interval) {
  uniroot(f, interval, extendInt = "yes", tol = 1e-14, maxiter = 10000)$root
}
t_limits <- function(t, df, level) {
  tail <- (1 - level) / 2
  wide <- t + c(-3, 3) * sqrt(1 + t^2 / (2 * df))
  c(root(function(d) pt(t, df, d, lower.tail = FALSE) - tail, wide),
    root(function(d) pt(t, df, d) - tail, wide))
}
lower_f <- function(f, n, df, lambda) {
  j <- 0:3000
  sum(dpois(j, lambda / 2) * pbeta(n * f / (n * f + df), n / 2 + j, df / 2))
}
upper_f <- function(f, n, df, lambda) {
  j <- 0:3000
  sum(dpois(j, lambda / 2) * pbeta(n * f / (n * f + df), n / 2 + j, df / 2, lower.tail = FALSE))
}
f_limits <- function(f, n, df, level) {
  tail <- (1 - level) / 2
  wide <- c(0, 4 * n * f + 20)
  c(if (pf(f, n, df, lower.tail = FALSE) >= tail) 0 else
      root(function(l) upper_f(f, n, df, l) - tail, wide),
    if (pf(f, n, df) <= tail) 0 else root(function(l) lower_f(f, n, df, l) - tail, wide))
}
same <- function(ours, theirs) stopifnot(abs(ours - unlist(theirs)) < 2e-3 * (0.1 + abs(ours)))
correction <- function(df) exp(lgamma(df / 2) - log(df / 2) / 2 - lgamma((df - 1) / 2))

unequal <- split(data_set("unequal")$value, data_set("unequal")$group)
study <- split(data_set("study")$score, data_set("study")$condition)
samples <- list("a and b" = unequal[c("a", "b")], "b and d" = unequal[c("b", "d")],
                study = study[c("visual", "haptic")])
pairs <- data_set("pairs")
long <- data_set("long_pairs")

procedure("Cohen's d and interval", "t.test; pt by uniroot; effectsize cohens_d")
for (case in names(samples)) for (level in c(0.95, 0.9)) {
  x <- samples[[case]]
  test <- t.test(x[[1]], x[[2]], var.equal = TRUE)
  scale <- sqrt(sum(1 / lengths(x)))
  d <- c(test$statistic, t_limits(test$statistic, test$parameter, level)) * scale
  same(d, cohens_d(x[[1]], x[[2]], ci = level)[c("Cohens_d", "CI_low", "CI_high")])
  answer(paste(case, level), d = d[1], low = d[2], high = d[3])
}
procedure("Hedges' g", "exact correction by lgamma; effectsize hedges_g")
for (case in names(samples)) {
  x <- samples[[case]]
  d <- cohens_d(x[[1]], x[[2]])$Cohens_d
  g <- d * correction(sum(lengths(x)) - 2)
  same(g, hedges_g(x[[1]], x[[2]])["Hedges_g"])
  answer(case, g = g)
}
procedure("d_z and interval", "t.test; pt by uniroot; effectsize cohens_d")
for (case in c("pairs", "long pairs")) {
  x <- if (case == "pairs") pairs else long
  test <- t.test(x$first, x$second, paired = TRUE)
  d <- c(test$statistic, t_limits(test$statistic, test$parameter, 0.95)) / sqrt(nrow(x))
  same(d, cohens_d(x$first, x$second, paired = TRUE)[c("Cohens_d", "CI_low", "CI_high")])
  answer(case, d = d[1], low = d[2], high = d[3])
}

f_values <- list("2 and 22" = c(8.65, 2, 22), "3 and 36" = c(1.354, 3, 36), "1 and 9" = c(0.2, 1, 9),
                 "2 and 861" = c(40, 2, 861), "5 and 12.5" = c(300, 5, 12.5))
procedure("Eta squared (partial) and interval", "dpois * pbeta by uniroot; effectsize F_to_eta2")
for (case in names(f_values)) for (level in c(0.9, 0.95)) {
  v <- f_values[[case]]
  limits <- f_limits(v[1], v[2], v[3], level)
  theirs <- F_to_eta2(v[1], v[2], v[3], ci = level, alternative = "two.sided")
  value <- v[1] * v[2] / (v[1] * v[2] + v[3])
  # effectsize divides by lambda + df_error, Steiger by lambda + the number of cases
  same(c(value, limits / (limits + v[3])), theirs[c("Eta2_partial", "CI_low", "CI_high")])
  cases <- v[2] + v[3] + 1
  answer(paste(case, level), eta = value, low = limits[1] / (limits[1] + cases),
         high = limits[2] / (limits[2] + cases))
}
procedure("Eta squared of one-way designs", "aov; effectsize eta_squared")
for (case in c("unequal", "ties")) {
  fit <- aov(value ~ group, data_set(case))
  answer(case, eta = eta_squared(fit, partial = FALSE)$Eta2)
}
procedure("Generalized eta squared", "aov with Error; effectsize eta_squared(generalized = TRUE)")
fit <- aov(value ~ condition + Error(subject / condition), data_set("times"))
answer("times", ges = eta_squared(fit, generalized = TRUE)$Eta2_generalized)
finish()
