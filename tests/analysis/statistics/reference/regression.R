source("reference.R")

fit <- function(case, model) {
  s <- summary(model)
  k <- coef(s)
  answer(case, estimate = k[, 1], error = k[, 2], t = k[, 3], p = k[, 4],
         low = confint(model)[, 1], high = confint(model)[, 2], deviation = s$sigma,
         r_squared = s$r.squared, adjusted = s$adj.r.squared, f = s$fstatistic[1],
         p_model = pf(s$fstatistic[1], s$fstatistic[2], s$fstatistic[3], lower.tail = FALSE))
}

procedure("Linear regression", "lm")
fit("pairs", lm(second ~ first, data_set("pairs")))
fit("long pairs", lm(second ~ first, data_set("long_pairs")))
study <- data_set("study")
study$trial <- as.numeric(study$trial)
fit("study", lm(score ~ trial + I(trial^2) + I(condition == "visual") +
                  I(condition == "visuohaptic") + I(group == "novice"), study))
finish()
