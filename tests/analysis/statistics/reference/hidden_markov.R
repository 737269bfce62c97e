source("reference.R")
suppressMessages(library(msm))

# States that change in continuous time, seen once a unit of time through normal noise.
series <- data_set("hidden")
rates <- rbind(c(-0.20, 0.15, 0.05), c(0.10, -0.25, 0.15), c(0.05, 0.15, -0.20))
fit <- msm(value ~ time, data = series, qmatrix = rates, fixedpars = TRUE,
           initprobs = c(0.5, 0.3, 0.2),
           hmodel = list(hmmNorm(0, 0.8), hmmNorm(1.2, 0.7), hmmNorm(3, 1)))
path <- viterbi.msm(fit)

procedure("Hidden Markov model", "msm::msm, msm::viterbi.msm")
answer("three states", log_likelihood = -fit$minus2loglik / 2, path = path$fitted,
       posterior = as.vector(t(path$pstate)))
finish()
