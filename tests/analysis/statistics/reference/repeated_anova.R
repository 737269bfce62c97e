source("reference.R")

# Orthonormal contrasts of k levels, so that anova.mlm and mauchly.test see the contrasts alone:
# given all k conditions and X = ~1, mauchly.test of R 4.2 puts the number of conditions where that
# of contrasts belongs in one term of its p value.
orthonormal <- function(k) apply(contr.helmert(k), 2, function(x) x / sqrt(sum(x^2)))
constant <- function(k) matrix(1 / sqrt(k), k)

effect <- function(case, scores) {
  fit <- lm(scores ~ 1)
  if (ncol(scores) == 1) {
    test <- t.test(scores[, 1])
    answer(case, f = unname(test$statistic)^2, df = 1, df_error = test$parameter, p = test$p.value)
    return(invisible())
  }
  table <- anova(fit, test = "Spherical")
  epsilon <- stats:::sphericity(SSD(fit))
  mauchly <- mauchly.test(fit)
  answer(case, f = table[1, "F"], df = table[1, "num Df"], df_error = table[1, "den Df"],
         p = table[1, "Pr(>F)"], p_gg = table[1, "G-G Pr"], p_hf = table[1, "H-F Pr"],
         gg = epsilon$GG.eps, hf = epsilon$HF.eps, w = mauchly$statistic, p_w = mauchly$p.value)
}

squares <- function(case, fit, strata) {
  tables <- summary(fit)
  for (name in names(strata)) {
    table <- tables[[strata[[name]]]][[1]]
    answer(paste(case, name), squares = table[1, "Sum Sq"], squares_error = table[2, "Sum Sq"])
  }
}

wide <- function(data, value, columns) {
  tapply(data[[value]], c(data["subject"], data[columns]), mean)
}

procedure("Repeated-measures ANOVA: one factor",
          "anova(lm(contrasts ~ 1), test = 'Spherical'); mauchly.test; aov")
one_factor <- function(case, table) {
  effect(paste(case, "condition"), table %*% orthonormal(ncol(table)))
  long <- data.frame(value = c(table), subject = factor(c(row(table))),
                     condition = factor(c(col(table))))
  fit <- aov(value ~ condition + Error(subject / condition), long)
  squares(case, fit, c(condition = "Error: subject:condition"))
  answer(case, participants = summary(fit)[["Error: subject"]][[1]][1, "Sum Sq"])
}
study <- data_set("study")
times <- data_set("times")
one_factor("study", wide(study, "score", "condition"))
one_factor("times", wide(times, "value", "condition"))
one_factor("times of five", wide(times, "value", "condition")[1:5, ])

procedure("Repeated-measures ANOVA: two factors",
          "anova(lm(contrasts ~ 1), test = 'Spherical'); mauchly.test; aov")
two_factors <- function(case, data, value, a, b) {
  cells <- wide(data, value, c(b, a))  # b runs fastest
  table <- matrix(cells, nrow(cells))
  ka <- nlevels(data[[a]])
  kb <- nlevels(data[[b]])
  effect(paste(case, "a"), table %*% (orthonormal(ka) %x% constant(kb)))
  effect(paste(case, "b"), table %*% (constant(ka) %x% orthonormal(kb)))
  effect(paste(case, "a:b"), table %*% (orthonormal(ka) %x% orthonormal(kb)))
  long <- as.data.frame(as.table(cells), responseName = "value")
  long$a <- long[[a]]
  long$b <- long[[b]]
  fit <- aov(value ~ a * b + Error(subject / (a * b)), long)
  squares(case, fit, c(a = "Error: subject:a", b = "Error: subject:b",
                       "a:b" = "Error: subject:a:b"))
}
two_factors("study", study, "score", "condition", "repetition")
halves <- subset(study, repetition != "r3")
halves$repetition <- factor(halves$repetition)
two_factors("two repetitions", halves, "score", "condition", "repetition")
finish()
