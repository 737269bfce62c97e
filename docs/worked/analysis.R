# The report's main numbers from scores.csv, with R alone.
#   Rscript analysis.R scores.csv
show <- function(name, value) cat(name, format(value, digits = 15), "\n")

scores <- read.csv(commandArgs(trailingOnly = TRUE)[1])
scores$subject <- factor(scores$subject)
scores$condition <- factor(scores$condition)

# Means of the conditions over trials.
for (name in levels(scores$condition)) {
  show(paste("mean", name), mean(scores$score[scores$condition == name]))
}

# As published: every trial counts as independent.
pooled <- summary(aov(score ~ condition, scores))[[1]]
show("anova_F", pooled[1, "F value"])
show("anova_p", pooled[1, "Pr(>F)"])
for (pair in list(c("visual", "haptic"), c("visuohaptic", "visual"))) {
  if (all(pair %in% levels(scores$condition))) {
    test <- t.test(scores$score[scores$condition == pair[1]],
                   scores$score[scores$condition == pair[2]],
                   alternative = "less", var.equal = TRUE)
    show(paste0("t ", pair[1], "<", pair[2]), unname(test$statistic))
    show(paste0("p ", pair[1], "<", pair[2]), test$p.value)
  }
}

# Repeated measures: one mean for each participant and condition.
means <- tapply(scores$score, list(scores$subject, scores$condition), mean)
means <- means[complete.cases(means), ]
long <- data.frame(score = as.vector(means), subject = factor(rep(rownames(means), ncol(means))),
                   condition = factor(rep(colnames(means), each = nrow(means))))
within <- summary(aov(score ~ condition + Error(subject / condition), long))
within <- within[["Error: subject:condition"]][[1]]
f <- within[1, "F value"]
show("repeated_F", f)
show("repeated_p", within[1, "Pr(>F)"])

# Greenhouse and Geisser: how far the differences between conditions are from equal variances.
n <- nrow(means)
k <- ncol(means)
centre <- diag(k) - 1 / k
covariance <- centre %*% cov(means) %*% centre
epsilon <- sum(diag(covariance))^2 / ((k - 1) * sum(covariance^2))
show("repeated_epsilon", epsilon)
show("repeated_p_corrected",
     pf(f, epsilon * (k - 1), epsilon * (n - 1) * (k - 1), lower.tail = FALSE))
