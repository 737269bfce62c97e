source("reference.R")

procedure("Welch's ANOVA", "oneway.test(value ~ group)")
for (name in c("unequal", "ties")) {
  data <- data_set(name)
  test <- oneway.test(value ~ factor(group), data)
  answer(name, f = test$statistic[[1]], df_between = test$parameter[[1]],
         df_within = test$parameter[[2]], p = test$p.value)
}

procedure("Two-way ANOVA type III", "drop1(aov(...), . ~ ., test = \"F\")")
for (name in c("unequal", "ties")) {
  data <- data_set(name)
  data$a <- factor(data$group)
  data$b <- factor(seq_len(nrow(data)) %% 3 == 0)
  contrasts(data$a) <- contr.sum(nlevels(data$a))
  contrasts(data$b) <- contr.sum(2)
  table <- drop1(aov(value ~ a * b, data), . ~ ., test = "F")
  for (effect in c("a", "b", "a:b")) {
    answer(paste(name, effect), f = table[effect, "F value"], df = table[effect, "Df"],
           squares = table[effect, "Sum of Sq"], p = table[effect, "Pr(>F)"])
  }
}
finish()
