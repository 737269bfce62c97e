source("reference.R")
suppressMessages(library(pROC))

curve <- function(case, positive, negative) {
  r <- roc(c(rep(0, length(negative)), rep(1, length(positive))), c(negative, positive),
           levels = c(0, 1), direction = "<", quiet = TRUE)
  ci <- ci.auc(r, method = "delong")
  wide <- ci.auc(r, method = "delong", conf.level = 0.99)
  answer(case, area = as.numeric(auc(r)), error = sqrt(var(r, method = "delong")), low = ci[1],
         high = ci[3], low_99 = wide[1], high_99 = wide[3])
}

procedure("Area under a ROC curve", "pROC::ci.auc")
study <- data_set("study")
curve("study", study$score[study$group == "novice"], study$score[study$group == "expert"])
unequal <- data_set("unequal")
curve("unequal", unequal$value[unequal$group == "d"], unequal$value[unequal$group == "a"])
ties <- data_set("ties")
curve("ties", ties$value[ties$group == "c"], ties$value[ties$group == "a"])
curve("ties below", ties$value[ties$group == "a"], ties$value[ties$group == "c"])
finish()
