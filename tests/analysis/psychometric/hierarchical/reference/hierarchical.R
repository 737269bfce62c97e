# The model of docs/algorithms/hierarchical-functions.md in JAGS (Debian: r-cran-rjags), as a judge.
# Rscript hierarchical.R FILE GUESS [ITERATIONS]; FILE has the columns person and condition (from 0),
# level, ones, total, and two conditions. Prints median, 2.5 and 97.5 % of each number.
suppressMessages(library(rjags))

model <- "model {
  for (n in 1:N) {
    ones[n] ~ dbin(p[n], total[n])
    p[n] <- guess + (1 - guess - lapse[person[series[n]]]) *
            phi(C * (x[n] - m[series[n]]) * exp(-v[series[n]]))
  }
  for (s in 1:S) {
    m[s] ~ dnorm(mu[condition[s]] + b[person[s]], pow(threshold_within, -2))
    v[s] ~ dnorm(eta[condition[s]] + d[person[s]], pow(width_within, -2))
  }
  for (i in 1:P) {
    b[i] ~ dnorm(0, pow(threshold_between, -2))
    d[i] ~ dnorm(0, pow(width_between, -2))
    l[i] ~ dnorm(lapse_mean, pow(lapse_spread, -2))
    lapse[i] <- 0.2 * ilogit(l[i])
  }
  for (c in 1:2) {
    mu[c] ~ dnorm(0, 1)
    eta[c] ~ dnorm(-0.7, pow(1.5, -2))
  }
  threshold_between ~ dt(0, pow(0.25, -2), 3)T(0,)
  threshold_within ~ dt(0, pow(0.25, -2), 3)T(0,)
  width_between ~ dt(0, pow(0.5, -2), 3)T(0,)
  width_within ~ dt(0, pow(0.5, -2), 3)T(0,)
  lapse_spread ~ dt(0, pow(0.5, -2), 3)T(0,)
  lapse_mean ~ dnorm(-2, 1)
}"

arguments <- commandArgs(TRUE)
table <- read.csv(arguments[1])
iterations <- if (length(arguments) > 2) as.integer(arguments[3]) else 4000
range <- max(table$level) - min(table$level)
middle <- (max(table$level) + min(table$level)) / 2
key <- table$person * 2 + table$condition
keys <- sort(unique(key))
data <- list(N = nrow(table), P = max(table$person) + 1, S = length(keys), ones = table$ones,
             total = table$total, x = (table$level - middle) / range, series = match(key, keys),
             person = keys %/% 2 + 1, condition = keys %% 2 + 1,
             guess = as.numeric(arguments[2]), C = 2 * qnorm(0.95))
inits <- lapply(1:4, function(i) {
  list(.RNG.name = "base::Mersenne-Twister", .RNG.seed = i, threshold_between = 0.2,
       threshold_within = 0.1, width_between = 0.3, width_within = 0.2, lapse_spread = 0.5,
       lapse_mean = -2, eta = c(-0.7, -0.7), mu = c(0, 0))
})
begun <- proc.time()
sampler <- jags.model(textConnection(model), data, inits, n.chains = 4, n.adapt = 500, quiet = TRUE)
update(sampler, 500, progress.bar = "none")
draws <- coda.samples(sampler, c("mu", "eta", "threshold_between", "threshold_within",
                                 "width_between", "width_within", "lapse_mean"),
                      iterations, progress.bar = "none")
cat(sprintf("processor time %.1f s, effective draws %.0f\n",
            (proc.time() - begun)[["user.self"]], min(effectiveSize(draws))))
all <- as.matrix(draws)
print_interval <- function(name, values) {
  cat(name, format(quantile(values, c(0.5, 0.025, 0.975)), digits = 4), "\n")
}
for (c in 1:2) {
  print_interval(paste("threshold", c), middle + range * all[, paste0("mu[", c, "]")])
  print_interval(paste("width", c), range * exp(all[, paste0("eta[", c, "]")]))
}
print_interval("difference", range * (all[, "mu[2]"] - all[, "mu[1]"]))
print_interval("ratio of widths", exp(all[, "eta[2]"] - all[, "eta[1]"]))
print_interval("spread of thresholds",
               range * sqrt(all[, "threshold_between"]^2 + all[, "threshold_within"]^2))
print_interval("spread of a person's difference", range * sqrt(2) * all[, "threshold_within"])
print_interval("spread of ln width", sqrt(all[, "width_between"]^2 + all[, "width_within"]^2))
print_interval("lapse", 0.2 * plogis(all[, "lapse_mean"]))
