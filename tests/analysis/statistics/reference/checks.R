source("reference.R")

procedure("Levene", "anova(lm(abs(value - mean of group) ~ group))")
levene <- function(case, value, group, centre) {
  distance <- abs(value - ave(value, group, FUN = centre))
  table <- anova(lm(distance ~ factor(group)))
  answer(case, f = table[1, "F value"], df_between = table[1, "Df"], df_within = table[2, "Df"],
         p = table[1, "Pr(>F)"])
}
unequal <- data_set("unequal")
ties <- data_set("ties")
study <- data_set("study")
for (centre in list(mean, median)) {
  if (identical(centre, median)) {
    procedure("Brown-Forsythe", "anova(lm(abs(value - median of group) ~ group))")
  }
  levene("unequal", unequal$value, unequal$group, centre)
  levene("ties", ties$value, ties$group, centre)
  levene("study", study$score, study$condition, centre)
}

procedure("Shapiro-Wilk", "shapiro.test")
shapiro <- function(case, values) {
  test <- shapiro.test(values)
  answer(case, w = test$statistic, p = test$p.value)
}
for (n in c(3, 4, 5, 6, 7, 10, 11, 12, 13, 28, 864)) shapiro(paste("first", n), study$score[1:n])
shapiro("ties", ties$value)
shapiro("residuals", study$score - ave(study$score, study$condition))
i <- 1:5000
shapiro("5000", ((i * 7919) %% 5003 + (i * 104729) %% 5009 + (i * 1299709) %% 5011) / 64)
shapiro("one far away", c(1, 2, 3, 5, 4, 1000))
shapiro("ten equal", c(1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1000))
finish()
