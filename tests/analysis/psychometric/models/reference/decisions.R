# A judge of diffusion.h and meta_d.h: densities and a fit by rtdists (Debian: r-cran-rtdists), and
# meta-d' by a likelihood of this file's own. Rscript decisions.R prints the numbers of the tests;
# with a file name it writes the choices of the fit there.
suppressMessages(library(rtdists))
options(digits = 12)

density_at <- function(t, upper, v, a, t0, w) {
  ddiffusion(t, if (upper) "upper" else "lower", a = a, v = v, t0 = t0, z = w * a, precision = 6)
}
print(c(density_at(0.8, TRUE, 1, 1.5, 0.3, 0.5), density_at(0.8, FALSE, 1, 1.5, 0.3, 0.5),
        density_at(0.25, TRUE, -2, 0.8, 0.2, 0.3), density_at(3, FALSE, 0.5, 2.5, 0.4, 0.6),
        density_at(0.15, TRUE, 3, 1, 0.1, 0.5), density_at(0.5, TRUE, 0, 1, 0, 0.5)))

set.seed(4)
choices <- rdiffusion(120, a = 1.3, v = 1.2, t0 = 0.3)
choices$rt <- round(choices$rt, 3)
file <- commandArgs(trailingOnly = TRUE)
if (length(file) == 1) {
  write.csv(data.frame(upper = as.integer(choices$response == "upper"), time = choices$rt), file,
            row.names = FALSE, quote = FALSE)
}
loss <- function(p) {
  if (p[2] <= 0 || p[3] < 0 || p[3] >= min(choices$rt)) return(1e10)
  -sum(log(ddiffusion(choices$rt, choices$response, a = p[2], v = p[1], t0 = p[3], precision = 6)))
}
best <- list(par = c(1, 1, 0.2))
for (i in 1:6) best <- optim(best$par, loss, control = list(reltol = 1e-14, maxit = 5000))
print(c(best$par, -best$value))
# Ends of the 95 % interval of the drift by profile likelihood.
profile <- function(v) {
  inner <- list(par = best$par[2:3])
  for (i in 1:4) inner <- optim(inner$par, function(q) loss(c(v, q)), control = list(reltol = 1e-13))
  2 * (inner$value - best$value) - qchisq(0.95, 1)
}
print(c(uniroot(profile, c(best$par[1] - 1.5, best$par[1]), tol = 1e-6)$root,
        uniroot(profile, c(best$par[1], best$par[1] + 1.5), tol = 1e-6)$root))

# Counts of ratings from the surest "noise" on; the first k go with the answer "noise".
meta_loss <- function(p, noise, signal, k, slant) {
  m <- p[1]
  n <- length(noise)
  borders <- c(-Inf, p[2:k], slant * m, p[(k + 1):(n - 1)], Inf)
  if (any(diff(borders) <= 0)) return(1e10)
  sum <- 0
  for (side in list(1:k, (k + 1):n)) {
    for (kind in 1:2) {
      share <- diff(pnorm(borders, c(-m / 2, m / 2)[kind]))[side]
      sum <- sum - sum(list(noise, signal)[[kind]][side] * log(share / sum(share)))
    }
  }
  sum
}
meta <- function(noise, signal, k) {
  n <- length(noise)
  h <- qnorm((sum(signal[(k + 1):n]) + 0.5) / (sum(signal) + 1))
  f <- qnorm((sum(noise[(k + 1):n]) + 0.5) / (sum(noise) + 1))
  d <- h - f
  criterion <- -(h + f) / 2
  best <- list(par = c(d, criterion - (k - 1):1 / 2, criterion + 1:(n - k - 1) / 2))
  for (i in 1:8) {
    best <- optim(best$par, meta_loss, noise = noise, signal = signal, k = k,
                  slant = criterion / d, control = list(maxit = 20000, reltol = 1e-15))
  }
  curved <- optim(best$par, meta_loss, noise = noise, signal = signal, k = k,
                  slant = criterion / d, method = "BFGS", hessian = TRUE,
                  control = list(reltol = 1e-16))
  print(c(curved$par[1], d, criterion, curved$par[1] / d, -curved$value,
          sqrt(solve(curved$hessian)[1, 1])))
}
meta(c(36, 24, 17, 20, 10, 12, 9, 2), c(1, 4, 10, 11, 19, 18, 28, 39), 4)
meta(c(60, 30, 10, 15, 5, 0), c(3, 7, 12, 20, 38, 40), 3)
