# R's pt is right to 1e-12 absolute (AS 243), its pf only to 1e-9: F is summed here term by term from
# R's own Poisson and beta distributions, and pf and qf must agree to what they give. Probabilities
# below 1e-3 are left out.
source("reference.R")

kept <- function(case, p) answer(case, p = p[p > 1e-3])
lower_f <- function(f, n, df, lambda) {
  j <- 0:ceiling(lambda / 2 + 15 * sqrt(lambda / 2) + 60)
  sapply(n * f / (n * f + df),
         function(x) sum(dpois(j, lambda / 2) * pbeta(x, n / 2 + j, df / 2)))
}

procedure("Noncentral t", "pt(q, df, ncp)")
for (df in c(1, 2, 5.5, 11, 31, 574)) for (delta in c(-3, -0.4, 0.2, 2.5, 9, 30)) {
  kept(paste("lower", df, delta), pt(c(-6, -1, 0.3, 2, 8, 33), df, delta))
}
procedure("Noncentral F", "sum(dpois * pbeta); pf(q, df1, df2, ncp); qf")
for (n in c(1, 2, 7.5, 40)) for (df in c(3, 11, 31, 574)) for (lambda in c(0.1, 3, 40, 600)) {
  case <- paste(n, df, lambda)
  f <- c(0.05, 0.8, 2, 7, 60)
  p <- lower_f(f, n, df, lambda)
  stopifnot(abs(p - suppressWarnings(pf(f, n, df, lambda))) < 1e-8)
  kept(paste("lower", case), p)
  if (lambda < 100) {
    q <- sapply(c(0.05, 0.5, 0.95), function(p) {
      uniroot(function(f) lower_f(f, n, df, lambda) - p, c(0, 1e5), tol = 1e-15, maxiter = 1e4)$root
    })
    stopifnot(abs(q / qf(c(0.05, 0.5, 0.95), n, df, lambda) - 1) < 1e-6)
    answer(paste("quantile", case), q = q)
  }
}
finish()
