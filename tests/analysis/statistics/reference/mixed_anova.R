source("reference.R")

orthonormal <- function(k) apply(contr.helmert(k), 2, function(x) x / sqrt(sum(x^2)))

within <- function(case, table, row, epsilon, mauchly) {
  answer(case, f = table[row, "F"], df = table[row, "num Df"], df_error = table[row, "den Df"],
         p = table[row, "Pr(>F)"], p_gg = table[row, "G-G Pr"], p_hf = table[row, "H-F Pr"],
         gg = epsilon$GG.eps, hf = epsilon$HF.eps, w = mauchly$statistic, p_w = mauchly$p.value)
}

mixed <- function(case, data, value) {
  cells <- tapply(data[[value]], data[c("subject", "condition")], mean)
  group <- data$group[match(rownames(cells), data$subject)]
  scores <- cells %*% orthonormal(ncol(cells))
  fit <- lm(scores ~ group)
  epsilon <- stats:::sphericity(SSD(fit))
  mauchly <- mauchly.test(fit)
  table <- anova(fit, test = "Spherical")
  long <- as.data.frame(as.table(cells), responseName = "value")
  long$group <- group[match(long$subject, rownames(cells))]
  strata <- summary(aov(value ~ group * condition + Error(subject / condition), long))
  between <- strata[["Error: subject"]][[1]]
  inside <- strata[["Error: subject:condition"]][[1]]

  procedure_once("Mixed ANOVA: group", "aov(value ~ group * condition + Error(subject/condition))")
  answer(case, f = between[1, "F value"], df = between[1, "Df"], df_error = between[2, "Df"],
         squares = between[1, "Sum Sq"], squares_error = between[2, "Sum Sq"],
         p = between[1, "Pr(>F)"])
  procedure_once("Mixed ANOVA: interaction",
                 "anova(lm(contrasts ~ group), test = 'Spherical'); mauchly.test; aov")
  within(case, table, "group", epsilon, mauchly)
  answer(case, squares = inside[2, "Sum Sq"], squares_error = inside[3, "Sum Sq"])

  # Type III: the intercept last, after groups coded to sum to zero.
  procedure_once("Mixed ANOVA: condition",
                 "anova(full, reduced, test = 'Spherical') with contr.sum")
  codes <- contr.sum(nlevels(group))[group, , drop = FALSE]
  marginal <- anova(lm(scores ~ codes), lm(scores ~ codes - 1), test = "Spherical")
  answer(case, f = marginal[2, "F"], df = marginal[2, "num Df"], df_error = marginal[2, "den Df"],
         p = marginal[2, "Pr(>F)"], p_gg = marginal[2, "G-G Pr"], p_hf = marginal[2, "H-F Pr"])
}

# Cases run in turn through several procedures; each is announced once.
procedure_once <- function(name, call) {
  if (!any(startsWith(calls, paste0("@ ", name, " |")))) procedure(name, call)
  current <<- name
}

mixed("study", data_set("study"), "score")
mixed("times", data_set("times"), "value")
finish()
