# Thresholds of stiffness_discrimination from the tidy tables, with R alone: the psychometric
# function of each participant by maximum likelihood.
#   haptrial export --csv tables out/stiffness_discrimination-001
#   Rscript thresholds.R tables/levels.csv
reference <- 300  # stiffness of the other spring [N/m]
guess <- 0.5      # two intervals
at_half <- log(log(2))                        # z of the Weibull function where half is reached,
span <- log(-log(0.05)) - log(-log(0.95))     # and from 5 % to 95 %

levels <- read.csv(commandArgs(trailingOnly = TRUE)[1])
levels$x <- log10(levels$applied - reference)

# Probability of a right answer at x; threshold and width on the axis of x.
psi <- function(x, threshold, width, lapse) {
  z <- at_half + span * (x - threshold) / width
  guess + (1 - guess - lapse) * (1 - exp(-exp(z)))
}

fit <- function(trials) {
  likelihood <- function(p) {
    share <- psi(trials$x, p[1], exp(p[2]), p[3])
    share <- pmin(pmax(share, 1e-12), 1 - 1e-12)
    -sum(ifelse(trials$outcome == 1, log(share), log(1 - share)))
  }
  # From several beginnings, since a likelihood may have more than one top.
  starts <- expand.grid(threshold = quantile(trials$x, c(0.25, 0.5, 0.75)), width = c(0.3, 1, 2))
  tries <- apply(starts, 1, function(start) {
    optim(c(start[1], log(start[2]), 0.01), likelihood, method = "L-BFGS-B",
          lower = c(-5, log(0.01), 0), upper = c(5, log(20), 0.2),
          control = list(factr = 10, maxit = 1000))
  })
  tries[[which.min(sapply(tries, function(each) each$value))]]
}

for (who in unique(levels$subject)) {
  found <- fit(levels[levels$subject == who, ])
  cat(who, "threshold", format(reference + 10^found$par[1], digits = 8), "N/m, log-likelihood",
      format(-found$value, digits = 10), "\n")
}
