source("reference.R")

one_way <- function(case, value, group) {
  table <- anova(lm(value ~ factor(group)))
  answer(case, f = table[1, "F value"], df_between = table[1, "Df"], df_within = table[2, "Df"],
         between = table[1, "Sum Sq"], within = table[2, "Sum Sq"], p = table[1, "Pr(>F)"])
}

procedure("One-way ANOVA", "anova(lm(value ~ group))")
for (name in c("unequal", "ties")) {
  data <- data_set(name)
  one_way(name, data$value, data$group)
}
study <- data_set("study")
one_way("study", study$score, study$condition)
offset <- data_set("offset")
one_way("offset", offset$value - 1e12, offset$group)  # exact: lm would lose the digits
finish()
